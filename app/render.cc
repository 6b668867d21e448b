#include <memory>

#include "app/console.h"
#include "app/filming.h"
#include "app/load_model.h"
#include "error.h"
#include "sim/experiment/registration.h"
#include "sim/film/film_recipe.h"
#include "sim/film/side_by_side.h"
#include "sim/film/video.h"
#include "sim/io/output_folder.h"
#include "sim/simulation/registration_fit.h"

namespace continuum {
namespace {

struct Options {
  std::string experiment, out;
  Filming filming;
};

// What is filmed; a recipe also says how.
Clip Read(const Options& o) {
  if (Clip::Is(o.experiment)) return Clip::Read(o.experiment);
  return {Experiment::Read(o.experiment), {}};
}

// Both halves together are as wide as a film of one.
void FilmBoth(const Clip& clip, const ModelSpec& system, const std::vector<std::size_t>& logs,
              const std::filesystem::path& out) {
  FilmOptions half = clip.film;
  half.width /= 2;
  const ModelSpec other = clip.Beside(system);
  FilmSideBySide({clip.experiment, system, clip.film.caption, false},
                 {clip.experiment, other, clip.beside->caption, false}, logs, out, half);
}

void RunRender(const Options& o) {
  Clip clip = Read(o);
  Experiment& e = clip.experiment;
  FilmOptions& film = clip.film;
  const ModelSpec system = LoadModel(e.model);
  o.filming.Set(film, system.model());
  const std::vector<std::size_t> logs = o.filming.LogsOf(e);
  const std::filesystem::path out = o.out;
  const bool picture = out.extension() == ".png";
  if (!picture && out.extension() != ".mp4")
    throw Error::Input("--out", "a name that ends in .mp4 or .png", "'" + o.out + "'");
  RequireWritable(out);
  if (!picture) RequireFilm(out, film.width, film.height, film.fps);
  e = Registered(e, system);
  if (picture) return PictureOf(e, system, logs.front(), out, film);
  if (clip.beside) return FilmBoth(clip, system, logs, out);
  FilmExperiment(e, system, logs, out, film);
}

}  // namespace

void AddRender(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub =
      app.add_subcommand("render", "Film the logs of an experiment, or a recipe, off-screen");
  sub->add_option("experiment", o->experiment, "EXPERIMENT.yaml, or a recipe of renders/")
      ->required();
  sub->add_option("--out", o->out, "OUT.mp4, or OUT.png for one frame")->required();
  o->filming.AddTo(*sub);
  sub->footer(
      "Example:\n  continuum render models/annelida/demo/annelida.yaml --out arm.mp4 --size "
      "1280x720");
  sub->callback([o] { RunRender(*o); });
}

}  // namespace continuum
