#include <memory>
#include <numeric>
#include <sstream>

#include "app/console.h"
#include "error.h"
#include "sim/clip.h"
#include "sim/output.h"
#include "sim/registration.h"

namespace continuum {
namespace {

struct Options {
  std::string experiment, out, size = "960x720", camera, gl = "osmesa", log;
  int fps = 25;
};

// "960x720"
void ReadSize(const std::string& text, FilmOptions& film) {
  std::istringstream in(text);
  char by = 0;
  in >> film.width >> by >> film.height;
  const auto allowed = [](int n) { return 64 <= n && n <= 16384; };
  const bool whole = in && by == 'x' && in.peek() == std::istringstream::traits_type::eof();
  if (whole && allowed(film.width) && allowed(film.height)) return;
  throw Error::Input("--size", "WIDTHxHEIGHT, each from 64 to 16384 px", "'" + text + "'");
}

// What is filmed; a recipe also says how.
Experiment Read(const Options& o, FilmOptions& film) {
  if (!Clip::Is(o.experiment)) return Experiment::Read(o.experiment);
  Clip clip = Clip::Read(o.experiment);
  film = std::move(clip.film);
  return std::move(clip.experiment);
}

void RunRender(const Options& o) {
  FilmOptions film;
  Experiment e = Read(o, film);
  ReadSize(o.size, film);
  film.fps = o.fps;
  if (!o.camera.empty()) {
    film.camera = o.camera;
    film.view.reset();
  }
  film.gl = ParseGl(o.gl);
  film.progress = ShowProgress;
  const System system = System::Load(e.model);
  e = Registered(e, system);
  const std::filesystem::path out = o.out;
  if (!o.log.empty()) {
    std::erase_if(e.logs, [&](const Log& log) { return log.label != o.log; });
    if (e.logs.empty()) throw Error::Input("--log", "a log of the experiment", "'" + o.log + "'");
  }
  const bool picture = out.extension() == ".png";
  if (!picture && out.extension() != ".mp4")
    throw Error::Input("--out", "a name that ends in .mp4 or .png", "'" + o.out + "'");
  RequireWritable(out);
  if (picture) return PictureOf(e, system, out, film);
  std::vector<std::size_t> logs(e.logs.size());
  std::iota(logs.begin(), logs.end(), 0);
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
  sub->add_option("--size", o->size, "WIDTHxHEIGHT")->capture_default_str();
  sub->add_option("--fps", o->fps, "frames per second")
      ->check(WholeNumberWithin(1, 1000))
      ->capture_default_str();
  sub->add_option("--camera", o->camera, "a camera of the model");
  sub->add_option("--gl", o->gl, "osmesa or egl")->capture_default_str();
  sub->add_option("--log", o->log, "only this log");
  sub->footer(
      "Example:\n  continuum render models/annelida/demo/annelida.yaml --out arm.mp4 --size "
      "1280x720");
  sub->callback([o] { RunRender(*o); });
}

}  // namespace continuum
