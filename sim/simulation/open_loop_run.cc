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
#include "sim/simulation/initial_state.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

// Whether an actuator gives the same force whatever its control, so that a log needs no column.
bool TakesNoControl(const mjModel& m, int actuator) {
  return m.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         m.actuator_gainprm[mjNGAIN * actuator] == 0;
}

constexpr double kDefaultEnd = 10;  // [s]
constexpr double kSameTime = 1e-9;  // [s]
constexpr double kMostRows = 1e7;   // some gigabytes

// A control of an actuator, and the column that has its values: "motor", or "servo[1]" where the
// actuator has several.
struct ControlColumn {
  std::string name;
  int actuator;
};

std::vector<ControlColumn> ColumnsOf(const OpenLoopOptions& o, const mjModel& m) {
  std::vector<ControlColumn> columns;
  for (int a = 0; a < m.nactuator; ++a) {
    const char* const name = mj_id2name(&m, mjOBJ_ACTUATOR, a);
    const int count = m.actuator_ctrlnum[a];
    if (count > 0 && (!name || !*name)) {
      throw Error::Input(o.model, "a name for every actuator, for the columns of " + o.input,
                         fmt::format("none for actuator {}", a));
    }
    for (int k = 0; k < count; ++k)
      columns.push_back({count == 1 ? name : fmt::format("{}[{}]", name, k), a});
  }
  return columns;
}

void CheckColumns(const CsvTable& table, const std::vector<ControlColumn>& controls,
                  const mjModel& m, const std::string& model) {
  std::string all = "time";
  for (const auto& control : controls) all += ", " + control.name;
  for (const auto& column : table.columns()) {
    const bool known = std::any_of(controls.begin(), controls.end(),
                                   [&](const ControlColumn& c) { return c.name == column; });
    if (known || column == "time") continue;
    throw Error::Input(table.name() + ":1", "the columns " + all + " (controls of " + model + ")",
                       "'" + column + "'");
  }
  for (const auto& [name, a] : controls) {
    if (m.actuator_ctrlnum[a] == 1 || table.Has(name)) continue;
    throw Error::Input(table.name() + ":1", "the columns " + all + " (controls of " + model + ")",
                       "none '" + name + "', though actuator '" +
                           mj_id2name(&m, mjOBJ_ACTUATOR, a) + "' has " +
                           std::to_string(m.actuator_ctrlnum[a]) + " controls");
  }
}

// What --input says, or all controls zero from 0 s on.
struct Controls {
  std::vector<double> time;
  std::vector<std::string> actuator;       ///< [control] as an input of an experiment names it
  std::vector<std::vector<double>> value;  ///< [control][row]
};

// Of the keyframe, where there is one.
Controls HeldControls(const OpenLoopOptions& o, const mjModel& m) {
  Controls c{{0}, {}, {}};
  const int key = o.keyframe.empty() ? -1 : mj_name2id(&m, mjOBJ_KEY, o.keyframe.c_str());
  if (key < 0) return c;
  for (const auto& [name, a] : ColumnsOf(o, m)) c.actuator.push_back(name);
  for (int u = 0; u < m.nu; ++u) c.value.push_back({m.key_ctrl[key * m.nu + u]});
  return c;
}

Controls ReadControls(const OpenLoopOptions& o, const mjModel& m) {
  if (o.input.empty()) return HeldControls(o, m);
  Controls c{{0}, {}, {}};
  const std::vector<ControlColumn> columns = ColumnsOf(o, m);
  const CsvTable table = CsvTable::Read(o.input);
  CheckColumns(table, columns, m, o.model);
  c.time = table.Numbers("time");
  if (c.time.empty()) throw Error::Input(o.input, "at least one row", "none");
  for (std::size_t k = 1; k < c.time.size(); ++k) {
    if (!(c.time[k] > c.time[k - 1])) {
      throw Error::Input(table.Where(k) + ", column 'time'", "increasing time",
                         Decimal(c.time[k]) + " after " + Decimal(c.time[k - 1]));
    }
  }
  for (const auto& [name, a] : columns) {
    const bool needed = !TakesNoControl(m, a) || table.Has(name);
    c.actuator.push_back(name);
    c.value.push_back(needed ? table.Numbers(name) : std::vector(c.time.size(), 0.0));
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

InitialState KeyframeState(ModelAndData& machine, const std::string& name) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  const int key = mj_name2id(&m, mjOBJ_KEY, name.c_str());
  if (key < 0) {
    std::string all;
    for (int k = 0; k < m.nkey; ++k) {
      const char* const known = mj_id2name(&m, mjOBJ_KEY, k);
      if (known) all += (all.empty() ? "" : ", ") + std::string(known);
    }
    throw Error::Input("--keyframe", "a keyframe of the model: " + (all.empty() ? "none" : all),
                       "'" + name + "'");
  }
  mj_resetDataKeyframe(&m, &d, key);
  d.time = 0;
  return {{d.qpos, d.qpos + m.nq}, {d.qvel, d.qvel + m.nv}, MemoryOf(m, d)};
}

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
