#include "sim/replay/replay.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/filming.h"
#include "app/load_model.h"
#include "app/log_check.h"
#include "identification/identify.h"
#include "sim/experiment/registration.h"
#include "sim/film/video.h"
#include "sim/io/file.h"
#include "sim/io/output_folder.h"
#include "sim/io/rounded.h"
#include "sim/replay/replay_report.h"
#include "sim/replay/sensor_score.h"

namespace continuum {
namespace {

struct Options {
  std::string experiment, out;
  bool video = false;
  Filming filming;
};

// "plate3 validate loaded: off by 11.7 mm RMS, 10.3 mean, 3.1 % of its RMS, 5001 rows".
void PrintSensors(const std::vector<SensorScore>& sensors) {
  for (const SensorScore& s : sensors) {
    if (!s.condition.empty() && s.use != "validate") continue;  // in errors.json
    std::string line = s.source;
    for (const std::string& word : {s.quantity, s.use.empty() ? "all" : s.use, s.condition})
      line += word.empty() ? "" : " " + word;
    line += fmt::format(": off by {:.4g} {} RMS, {:.4g} mean", s.rms, s.unit, s.mean);
    if (s.relative > 0) line += fmt::format(", {:.3g} % of its RMS", 100 * s.relative);
    std::printf("%s, %zu rows\n", line.c_str(), s.rows);
  }
}

void RunReplay(const Options& o) {
  Experiment e = Experiment::Read(o.experiment);
  const ModelSpec system = LoadModel(e.model);
  CheckNames(e, system);
  CheckParameters(e, system);  // as a fit of all logs would take them
  PrintLogCheck(o.experiment, e);
  FilmOptions film;
  o.filming.Set(film, system.model());
  const std::vector<std::size_t> filmed = o.filming.LogsOf(e);
  std::vector<std::string> outputs{"errors.json", "simulated/", "report.html"};
  const std::filesystem::path folder = o.out;
  if (o.video) {
    RequireFilm(folder / "replay.mp4", film.width, film.height, film.fps);
    outputs.push_back("replay.mp4");
  }
  const OutputFolder made(o.out, outputs, {e.file, e.model});
  const auto logs = Replay(e, system, ShowProgress);
  EndProgress();
  std::vector<Trace> traces;
  std::vector<ChannelScore> scores;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    traces.push_back(logs[l].trace);
    for (const ChannelScore& s : logs[l].score) {
      std::printf(
          "%-28s %-8s %-12s rmse %.4g  mean abs. %.4g  largest %.4g %s at %s s  fit %s %%\n",
          e.logs[l].label.c_str(), e.logs[l].train ? "train" : "validate", s.channel.c_str(),
          s.rmse, s.mae, s.largest, s.unit.c_str(), Fixed(s.when, 3).c_str(),
          Fixed(s.fit, 1).c_str());
      scores.push_back(s);
    }
  }
  PrintSensors(ScoreSensors(e, logs));
  std::printf("all: %s%s\n", ErrorText(e, PooledError(e, logs)).c_str(),
              MeanAbsoluteErrorText(scores).c_str());
  for (const auto& line : RegistrationLines(e.registration)) std::printf("%s\n", line.c_str());
  auto errors = ErrorsJson(e, logs);
  const auto registration = RegistrationJson(e.registration);
  if (!registration.is_null()) errors["registration"] = registration;
  WriteFile(folder / "errors.json", errors.dump(2) + "\n");
  WriteSimulated(e, traces, folder / "simulated");
  WriteReplayReport(e, logs, folder / "report.html");
  std::fflush(stdout);  // before minutes of film
  if (o.video) FilmExperiment(e, system, filmed, folder / "replay.mp4", film);
  EndProgress();
  std::printf("report: %s\n", (folder / "report.html").c_str());
}

}  // namespace

void AddReplay(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub =
      app.add_subcommand("replay", "Simulate every log of an experiment as it stands");
  sub->add_option("experiment", o->experiment, "EXPERIMENT.yaml")->required();
  sub->add_option("--out", o->out, "folder for errors.json, simulated/, report.html")->required();
  auto* const video = sub->add_flag("--video", o->video, "also replay.mp4");
  for (CLI::Option* const option : o->filming.AddTo(*sub)) option->needs(video);
  sub->footer("Example:\n  continuum replay models/annelida/demo/annelida.yaml --out out");
  sub->callback([o] { RunReplay(*o); });
}

}  // namespace continuum
