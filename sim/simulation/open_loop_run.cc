#include "sim/simulation/open_loop_run.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

// Whether an actuator gives the same force whatever its control, so that a log needs no column.
bool TakesNoControl(const mjModel& m, std::size_t actuator) {
  return m.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         m.actuator_gainprm[mjNGAIN * actuator] == 0;
}

constexpr double kDefaultEnd = 10;  // [s]
constexpr double kSameTime = 1e-9;  // [s]
constexpr double kMostRows = 1e7;   // some gigabytes

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

Controls ReadControls(const OpenLoopOptions& o, const mjModel& m) {
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
std::string GivenOptions(const std::vector<std::pair<std::string, double>>& options,
                         const std::string& otherwise) {
  std::string all;
  for (const auto& [name, value] : options) {
    if (value > 0) all += (all.empty() ? "" : " and ") + name;
  }
  return all.empty() ? otherwise : all;
}

double EndOf(const OpenLoopOptions& o, const Controls& c) {
  const double end = o.until > 0 ? o.until : o.input.empty() ? kDefaultEnd : c.time.back();
  if (end >= c.time.front()) return end;
  throw Error::Input(
      "--until",
      "an end after the first row of " + o.input + ", at " + Decimal(c.time.front()) + " s",
      Decimal(end) + " s");
}

void CheckSteps(const OpenLoopOptions& o, double begin, double end, double timestep) {
  if ((end - begin) / timestep <= kMostSteps) return;
  throw Error::Input(GivenOptions({{"--until", o.until}, {"--timestep", o.timestep}},
                                  o.input.empty() ? o.model : o.input),
                     fmt::format("at most {:g} time steps of {} s", kMostSteps, Decimal(timestep)),
                     Decimal(end - begin) + " s");
}

// When rows are written: at multiples of a period, or (0) at the input's own rows.
std::set<double> Written(const OpenLoopOptions& o, const Controls& c, double end, double period) {
  if (period == 0) return {c.time.begin(), c.time.end()};
  const double begin = c.time.front(), count = (end - begin) / period;
  if (!(count < kMostRows)) {
    throw Error::Input(
        GivenOptions({{"--until", o.until},
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

// Every actuator as an input of the log, held between the rows of the controls.
void AddInputs(const Controls& controls, Experiment& e, Log& log) {
  for (std::size_t a = 0; a < controls.actuator.size(); ++a) {
    Input in;
    in.actuator = in.column = controls.actuator[a];
    e.inputs.push_back(in);
    log.input.emplace_back();
    log.enable.emplace_back();
    std::size_t row = 0;
    for (const double t : log.time) {
      while (row + 1 < controls.time.size() && controls.time[row + 1] <= t + kSameTime) ++row;
      log.input.back().push_back(controls.value[a][row]);
    }
  }
}

}  // namespace

OpenLoopRun PlanRun(const OpenLoopOptions& o, const mjModel& m, double period) {
  OpenLoopRun run;
  Log log;
  log.label = fs::path(o.model).stem().string();
  log.file = o.input.empty() ? o.model : o.input;
  const Controls controls = ReadControls(o, m);
  const double end = EndOf(o, controls);
  CheckSteps(o, controls.time.front(), end, m.opt.timestep);
  const std::set<double> written = Written(o, controls, end, o.every > 0 ? o.every : period);
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
  AddInputs(controls, run.experiment, log);
  run.experiment.file = log.file;
  run.experiment.logs.push_back(std::move(log));
  return run;
}

std::string SensorHeader(const mjModel& m) {
  std::string text = "time";
  for (int s = 0; s < m.nsensor; ++s) {
    const char* const name = mj_id2name(&m, mjOBJ_SENSOR, s);
    const std::string column = name && *name ? name : fmt::format("sensor{}", s);
    for (int c = 0; c < m.sensor_dim[s]; ++c) {
      text += "," + column + (m.sensor_dim[s] > 1 ? fmt::format("[{}]", c) : "");
    }
  }
  return text + "\n";
}

}  // namespace continuum
