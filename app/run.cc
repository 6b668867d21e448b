#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "app/console.h"
#include "error.h"
#include "sim/film/film.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"
#include "sim/io/output_folder.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string model, input, out, video;
  double every = 0, until = 0, timestep = 0;
};

// Whether an actuator gives the same force whatever its control, so that a log needs no column.
bool TakesNoControl(const mjModel& m, std::size_t actuator) {
  return m.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         m.actuator_gainprm[mjNGAIN * actuator] == 0;
}

constexpr double kDefaultEnd = 10;     // [s]
constexpr double kSameTime = 1e-9;     // [s]
constexpr double kMostRows = 1e7;      // some gigabytes
constexpr double kFramePeriod = 0.02;  // [s]

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

void CheckColumns(const CsvTable& table, const std::vector<std::string>& actuators,
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

// What --input says, or all controls zero from 0 s on.
struct Controls {
  std::vector<double> time;
  std::vector<std::string> actuator;
  std::vector<std::vector<double>> value;  ///< [actuator][row]
};

Controls ReadControls(const Options& o, const mjModel& m) {
  Controls c{{0}, {}, {}};
  if (o.input.empty()) return c;
  c.actuator = Names(m, mjOBJ_ACTUATOR, static_cast<int>(m.nu));
  const auto unnamed = std::find(c.actuator.begin(), c.actuator.end(), "");
  if (unnamed != c.actuator.end()) {
    throw Error::Input(o.model, "a name for every actuator, for the columns of " + o.input,
                       fmt::format("none for actuator {}", unnamed - c.actuator.begin()));
  }
  const CsvTable table = CsvTable::Read(o.input);
  CheckColumns(table, c.actuator, o.model);
  c.time = table.Numbers("time");
  if (c.time.empty()) throw Error::Input(o.input, "at least one row", "none");
  for (std::size_t k = 1; k < c.time.size(); ++k) {
    if (!(c.time[k] > c.time[k - 1])) {
      throw Error::Input(table.Where(k) + ", column 'time'", "increasing time",
                         Decimal(c.time[k]) + " after " + Decimal(c.time[k - 1]));
    }
  }
  for (std::size_t a = 0; a < c.actuator.size(); ++a) {
    const bool needed = !TakesNoControl(m, a) || table.Has(c.actuator[a]);
    c.value.push_back(needed ? table.Numbers(c.actuator[a]) : std::vector(c.time.size(), 0.0));
  }
  return c;
}

// What makes a run too long: the options that were given, else what stands in for them.
std::string Blame(const std::vector<std::pair<std::string, double>>& options,
                  const std::string& otherwise) {
  std::string all;
  for (const auto& [name, value] : options) {
    if (value > 0) all += (all.empty() ? "" : " and ") + name;
  }
  return all.empty() ? otherwise : all;
}

double EndOf(const Options& o, const Controls& c) {
  const double end = o.until > 0 ? o.until : o.input.empty() ? kDefaultEnd : c.time.back();
  if (end >= c.time.front()) return end;
  throw Error::Input(
      "--until",
      "an end after the first row of " + o.input + ", at " + Decimal(c.time.front()) + " s",
      Decimal(end) + " s");
}

void CheckSteps(const Options& o, double begin, double end, double timestep) {
  if ((end - begin) / timestep <= kMostSteps) return;
  throw Error::Input(Blame({{"--until", o.until}, {"--timestep", o.timestep}},
                           o.input.empty() ? o.model : o.input),
                     fmt::format("at most {:g} time steps of {} s", kMostSteps, Decimal(timestep)),
                     Decimal(end - begin) + " s");
}

// When rows are written: at multiples of a period, or (0) at the input's own rows.
std::set<double> Written(const Options& o, const Controls& c, double end, double period) {
  if (period == 0) return {c.time.begin(), c.time.end()};
  const double begin = c.time.front(), count = (end - begin) / period;
  if (!(count < kMostRows)) {
    throw Error::Input(
        Blame({{"--until", o.until},
               {"--every", o.every},
               {"--timestep", o.every > 0 ? 0 : o.timestep}},
              o.input.empty() ? o.model : o.input),
        fmt::format("an end and a period that give at most {:g} rows", kMostRows),
        fmt::format("{} s from {} s to {} s", Decimal(period), Decimal(begin), Decimal(end)));
  }
  std::set<double> rows;
  for (int k = 0; begin + k * period <= end + kSameTime; ++k) rows.insert(begin + k * period);
  return rows;
}

Run Plan(const Options& o, const mjModel& m, double period) {
  Run run;
  Log log;
  log.label = std::filesystem::path(o.model).stem().string();
  log.file = o.input.empty() ? o.model : o.input;
  const Controls controls = ReadControls(o, m);
  const double end = EndOf(o, controls);
  CheckSteps(o, controls.time.front(), end, m.opt.timestep);
  const std::set<double> written = Written(o, controls, end, period);
  std::set<double> rows(controls.time.begin(), controls.time.end());
  rows.insert(written.begin(), written.end());
  rows.insert(end);
  double last = -std::numeric_limits<double>::infinity();
  for (const double t : rows) {
    if (t > end + kSameTime || t - last < kSameTime) continue;
    last = t;
    log.time.push_back(t);
    const auto nearest = written.lower_bound(t - kSameTime);
    run.written.push_back(nearest != written.end() && *nearest < t + kSameTime);
  }
  for (std::size_t a = 0; a < controls.actuator.size(); ++a) {
    Input in;
    in.actuator = in.column = controls.actuator[a];
    run.experiment.inputs.push_back(in);
    log.input.emplace_back();
    log.enable.emplace_back();
    std::size_t row = 0;
    for (const double t : log.time) {
      while (row + 1 < controls.time.size() && controls.time[row + 1] <= t + kSameTime) ++row;
      log.input.back().push_back(controls.value[a][row]);
    }
  }
  run.experiment.file = log.file;
  run.experiment.logs.push_back(std::move(log));
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
  if (!o.video.empty() && fs::path(o.video).extension() != ".mp4")
    throw Error::Input("--video", "a name that ends in .mp4", "'" + o.video + "'");
  const auto same = [](const std::string& a, const std::string& b) {
    return fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
  };
  if (!o.video.empty() && !o.out.empty() && same(o.video, o.out))
    throw Error::Input("--video", "another file than --out", "'" + o.video + "'");
  ModelSpec system = ModelSpec::Load(o.model);
  std::vector<Change> changes;
  if (o.timestep > 0) changes.push_back({"option", "timestep", o.timestep});
  ModelAndData machine = system.Build(changes);
  const mjModel& m = *machine.model;
  const double period = o.input.empty() ? m.opt.timestep : 0;
  const Run run = Plan(o, m, o.every > 0 ? o.every : period);
  const Run shown = o.video.empty() ? Run{} : Plan(o, m, o.every > 0 ? o.every : kFramePeriod);
  if (!o.out.empty()) RequireWritable(o.out, {o.model, o.input});
  if (!o.video.empty()) RequireWritable(o.video, {o.model, o.input});
  std::string csv = Header(*machine.model);
  Hooks hooks = Hooks::Stoppable();
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
