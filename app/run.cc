#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/console.h"
#include "app/load_model.h"
#include "error.h"
#include "sim/film/film.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"
#include "sim/io/output_folder.h"
#include "sim/simulation/open_loop_run.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

constexpr double kFramePeriod = 0.02;  // [s]

struct Options : OpenLoopOptions {
  std::string out, video;
};

void CheckOutputs(const Options& o) {
  if (!o.video.empty() && fs::path(o.video).extension() != ".mp4")
    throw Error::Input("--video", "a name that ends in .mp4", "'" + o.video + "'");
  const auto same = [](const std::string& a, const std::string& b) {
    return fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
  };
  if (!o.video.empty() && !o.out.empty() && same(o.video, o.out))
    throw Error::Input("--video", "another file than --out", "'" + o.video + "'");
}

void RunModel(const Options& o) {
  CheckOutputs(o);
  ModelSpec system = LoadModel(o.model);
  std::vector<Change> changes;
  if (o.timestep > 0) changes.push_back({"option", "timestep", o.timestep});
  ModelAndData machine = system.Build(changes);
  const mjModel& m = *machine.model;
  const double period = o.input.empty() ? m.opt.timestep : 0;
  const OpenLoopRun run = PlanRun(o, m, period);
  const OpenLoopRun filmed = o.video.empty() ? OpenLoopRun{} : PlanRun(o, m, kFramePeriod);
  if (!o.out.empty()) RequireWritable(o.out, {o.model, o.input});
  if (!o.video.empty()) RequireWritable(o.video, {o.model, o.input});
  std::string csv = SensorHeader(m);
  Hooks hooks = Hooks::Stoppable();
  hooks.row = [&](const mjModel& m, mjData& d, std::size_t row) {
    if (!run.written[row]) return;
    csv += Decimal(run.experiment.logs.front().time[row]);
    for (int i = 0; i < m.nsensordata; ++i) csv += "," + Decimal(d.sensordata[i]);
    csv += "\n";
  };
  const InitialState start =
      o.keyframe.empty() ? InitialState{} : KeyframeState(machine, o.keyframe);
  const Trace trace = Simulate(machine, run.experiment, run.experiment.logs.front(), start, hooks);
  if (trace.diverged) {
    throw Error::Job(
        fmt::format("{}: the simulation diverges at {:g} s", o.model, trace.diverged_at));
  }
  if (o.out.empty()) {
    std::fwrite(csv.data(), 1, csv.size(), stdout);
  } else {
    WriteFile(o.out, csv);
  }
  if (o.video.empty()) return;
  FilmOptions film;
  film.progress = ShowProgress;
  film.start = start;
  FilmExperiment(filmed.experiment, system.With(changes, {}), {0}, o.video, film);
}

}  // namespace

void AddRun(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub = app.add_subcommand("run", "Simulate a model without a window");
  sub->add_option("model", o->model, "MJCF file")->required();
  sub->add_option("--input", o->input, "CSV with time and one column per control");
  sub->add_option("--keyframe", o->keyframe,
                  "begin at this keyframe of the model, and hold its controls without --input");
  sub->add_option("--out", o->out, "CSV of all sensors (default: standard output)");
  sub->add_option("--every", o->every, "write every S seconds instead of at the input's rows")
      ->check(NumberWithin(1e-9, 1e9));
  sub->add_option("--until", o->until, "end [s] (default: the input's last row, or 10)")
      ->check(NumberWithin(1e-9, 1e9));
  sub->add_option("--timestep", o->timestep, "instead of the model's [s]")
      ->check(NumberWithin(1e-9, 1e3));
  sub->add_option("--video", o->video, "MP4 film");
  sub->footer(
      "Example:\n  continuum run models/annelida/annelida.xml --input pull.csv --out angles.csv "
      "--video arm.mp4");
  sub->callback([o] { RunModel(*o); });
}

}  // namespace continuum
