#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "app/console.h"
#include "error.h"
#include "sim/file.h"
#include "sim/film.h"
#include "sim/table.h"

namespace continuum {
namespace {

struct Options {
  std::string model, input, out, video;
  double every = 0, until = 0, timestep = 0;
};

// Whether an actuator gives the same force whatever its control, so that a log needs no column.
bool TakesNoControl(const mjModel& m, std::size_t actuator) {
  return m.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         m.actuator_gainprm[mjNGAIN * actuator] == 0;
}

// The run as an experiment: every actuator an input, rows where something is read or written.
struct Run {
  Experiment experiment;
  std::vector<bool> written;  ///< [row]
};

std::vector<std::string> Names(const mjModel& m, mjtObj type, int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    const char* name = mj_id2name(&m, type, i);
    names.push_back(name ? name : "");
  }
  return names;
}

void CheckColumns(const Table& table, const std::vector<std::string>& actuators,
                  const std::string& model) {
  for (const auto& column : table.columns()) {
    if (column == "time" ||
        std::find(actuators.begin(), actuators.end(), column) != actuators.end())
      continue;
    std::string all = "time";
    for (const auto& name : actuators) all += ", " + name;
    throw Error::Input(table.name() + ":1", "the columns " + all + " (actuators of " + model + ")",
                       "'" + column + "'");
  }
}

Run Plan(const Options& o, const mjModel& m) {
  Run run;
  Log log;
  log.label = std::filesystem::path(o.model).stem().string();
  const auto actuators = Names(m, mjOBJ_ACTUATOR, static_cast<int>(m.nu));
  std::vector<double> times{0};
  std::vector<std::vector<double>> controls(actuators.size(), std::vector<double>(1, 0.0));
  double end = o.until;
  if (!o.input.empty()) {
    const Table table = Table::Read(o.input);
    CheckColumns(table, actuators, o.model);
    times = table.Numbers("time");
    if (times.empty()) throw Error::Input(o.input, "at least one row", "none");
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (!(times[k] > times[k - 1])) {
        throw Error::Input(table.Where(k) + ", column 'time'", "increasing time",
                           Decimal(times[k]) + " after " + Decimal(times[k - 1]));
      }
    }
    for (std::size_t a = 0; a < actuators.size(); ++a) {
      const bool needed = !TakesNoControl(m, a) || table.Has(actuators[a]);
      controls[a] = needed ? table.Numbers(actuators[a]) : std::vector(times.size(), 0.0);
    }
    if (end == 0) end = times.back();
  }
  if (o.input.empty() && end == 0) end = 10;
  // Rows of the input, and rows to be written.
  std::set<double> rows(times.begin(), times.end());
  std::set<double> written;
  if (o.every > 0) {
    for (int k = 0; times.front() + k * o.every <= end + 1e-9; ++k)
      written.insert(times.front() + k * o.every);
  } else if (o.input.empty()) {
    for (int k = 0; k * m.opt.timestep <= end + 1e-9; ++k) written.insert(k * m.opt.timestep);
  } else {
    written = rows;
  }
  rows.insert(written.begin(), written.end());
  if (end > times.front()) rows.insert(end);
  double last = -std::numeric_limits<double>::infinity();
  for (const double t : rows) {
    if (t > end + 1e-9 || t - last < 1e-9) continue;
    last = t;
    log.time.push_back(t);
    const auto nearest = written.lower_bound(t - 1e-9);
    run.written.push_back(nearest != written.end() && *nearest < t + 1e-9);
  }
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    Input in;
    in.actuator = in.column = actuators[a];
    run.experiment.inputs.push_back(in);
    log.input.emplace_back();
    log.enable.emplace_back();
    std::size_t row = 0;
    for (const double t : log.time) {
      while (row + 1 < times.size() && times[row + 1] <= t + 1e-9) ++row;
      log.input.back().push_back(controls[a][row]);
    }
  }
  run.experiment.logs.push_back(std::move(log));
  run.experiment.file = o.input.empty() ? o.model : o.input;
  return run;
}

std::string Header(const mjModel& m) {
  std::string text = "time";
  for (int s = 0; s < m.nsensor; ++s) {
    const char* const name = mj_id2name(&m, mjOBJ_SENSOR, s);
    const std::string shown = name && *name ? name : fmt::format("sensor{}", s);
    for (int c = 0; c < m.sensor_dim[s]; ++c) {
      text += "," + shown + (m.sensor_dim[s] > 1 ? fmt::format("[{}]", c) : "");
    }
  }
  return text + "\n";
}

void RunModel(const Options& o) {
  System system = System::Load(o.model);
  std::vector<Change> changes;
  if (o.timestep > 0) changes.push_back({"option", "timestep", o.timestep});
  Machine machine = system.Build(changes);
  Run run = Plan(o, *machine.model);
  std::string csv = Header(*machine.model);
  Hooks hooks;
  hooks.row = [&](const mjModel& m, mjData& d, std::size_t row) {
    if (!run.written[row]) return;
    csv += Decimal(run.experiment.logs.front().time[row]);
    for (int i = 0; i < m.nsensordata; ++i) csv += "," + Decimal(d.sensordata[i]);
    csv += "\n";
  };
  const Trace trace = Simulate(machine, run.experiment, run.experiment.logs.front(), {}, hooks);
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
  Options frames = o;
  if (frames.every == 0) frames.every = 0.02;
  const Run shown = Plan(frames, *machine.model);
  FilmOptions film;
  film.progress = ShowProgress;
  FilmExperiment(shown.experiment, system.With(changes, {}), {0}, o.video, film);
}

}  // namespace

void AddRun(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub = app.add_subcommand("run", "Simulate a model without a window");
  sub->add_option("model", o->model, "MJCF file")->required();
  sub->add_option("--input", o->input, "CSV with time and one column per actuator");
  sub->add_option("--out", o->out, "CSV of all sensors (default: standard output)");
  sub->add_option("--every", o->every, "write every S seconds instead of at the input's rows")
      ->check(CLI::PositiveNumber);
  sub->add_option("--until", o->until, "end [s] (default: the input's last row, or 10)")
      ->check(CLI::PositiveNumber);
  sub->add_option("--timestep", o->timestep, "instead of the model's [s]")
      ->check(CLI::PositiveNumber);
  sub->add_option("--video", o->video, "MP4 film");
  sub->footer(
      "Example:\n  continuum run models/annelida/annelida.xml --input pull.csv --out angles.csv "
      "--video arm.mp4");
  sub->callback([o] { RunModel(*o); });
}

}  // namespace continuum
