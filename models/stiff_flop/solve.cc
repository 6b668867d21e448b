#include "models/stiff_flop/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "error.h"
#include "models/statics/details.h"
#include "models/statics/error_table.h"
#include "models/statics/foreign_options.h"
#include "models/statics/limited_search.h"
#include "models/statics/measured_points.h"
#include "models/statics/path_error.h"
#include "models/statics/plausible.h"
#include "models/statics/results.h"
#include "models/statics/rows.h"
#include "models/statics/sweep.h"
#include "models/statics/write_figure.h"
#include "models/stiff_flop/details.h"
#include "models/stiff_flop/equilibria.h"
#include "models/stiff_flop/figure.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"
#include "models/stiff_flop/learn.h"
#include "models/stiff_flop/outlines.h"
#include "models/stiff_flop/reach.h"
#include "models/stiff_flop/response.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

using namespace stiff_flop;
using stiff_flop::Axis;

using Names = std::vector<std::string>;

void RefuseOptions(const SolveRequest& request) {
  statics::RefuseForeignOptions(
      request, "stiff_flop",
      {{"--sensitivity with --calibrate", request.calibrate && request.sensitivity},
       {"--parameters without --calibrate", !request.calibrate && !request.parameters.empty()},
       {"--hybrid", !request.hybrid.empty()},
       {"--lambda", request.lambda.has_value()},
       {"--cross-validate", request.cross_validate},
       {"--follow", !request.follow.empty()}});
}

// --equilibria, --shape, --compliance and --reach are of the forward model, whose shape is not
// given.
void RefuseOfInverse(const SolveRequest& request, Direction direction) {
  if (direction == Direction::kForward) return;
  for (const auto& [option, given] :
       {std::pair("--equilibria", request.equilibria), std::pair("--shape", !request.shape.empty()),
        std::pair("--compliance", !request.compliance.empty()),
        std::pair("--reach", !request.reach.empty())}) {
    if (given) throw Error::Input(option, "cases with p1, p2, ..", "kappa");
  }
}

// The radius where it is a diameter, for one; tubes in tubes.
void WarnOfTubes(const SolveRequest& request, const Yaml& node, const Module& m) {
  if (m.r_o + m.r_c2 > m.r_2 || m.r_o - m.r_c2 < m.r_1) {
    request.warn(
        fmt::format("{}: tubes from {:.3g} to {:.3g} m, not within the wall, {:.3g} to {:.3g} m",
                    node.At("r_o").Where(), m.r_o - m.r_c2, m.r_o + m.r_c2, m.r_1, m.r_2));
  }
  for (std::size_t i = 0; i < m.lines.size(); ++i) {
    for (std::size_t k = i + 1; k < m.lines.size(); ++k) {
      const double between =
          m.r_o * std::hypot(m.lines[i][0] - m.lines[k][0], m.lines[i][1] - m.lines[k][1]);
      if (between >= 2 * m.r_c2) continue;
      request.warn(
          fmt::format("{}: lines {} and {} are {:.3g} m apart, less than the {:.3g} m of "
                      "a tube",
                      node.Where(), i + 1, k + 1, between, 2 * m.r_c2));
    }
  }
}

void WarnOfImplausibleModule(const SolveRequest& request, const Yaml& node, const Module& m) {
  const auto check = [&](const char* key, double value, double low, double high, const char* unit) {
    statics::WarnIfImplausible(request, node.At(key).Where(), value, low, high, unit);
  };
  check("r_2", m.r_2, 1e-3, 0.5, "m");
  check("l", m.l, m.r_2 / 2, 5, "m");
  check("l_fs", m.l_fs, 0, 5 * m.l, "m");
  check("E", m.E, 1e3, 1e9, "Pa");
  check("m", m.m, 1e-5, 20, "kg");
  check("m_fs", m.m_fs, 1e-6, 20, "kg");
  WarnOfTubes(request, node, m);
}

void WarnOfImplausibleRobot(const SolveRequest& request, const Robot& robot) {
  const Yaml file = Yaml::Read(request.robot);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < robot.series.size(); ++i) {
    const std::string name = robot.names[i];
    if (!seen.insert(name).second) continue;
    WarnOfImplausibleModule(request, file.At("modules").At(name), robot.series[i]);
  }
  statics::WarnIfImplausible(request, file.At("gravity").Where(), robot.gravity.norm(), 0.1, 100,
                             "m/s^2");
}

// Pressures are judged by E, forces by what lengthens the body to twice its length.
void WarnOfImplausibleCases(const SolveRequest& request, const Robot& robot, const Cases& cases) {
  const double force = robot.module().E * robot.module().Area();
  for (const Case& row : cases.rows) {
    const std::string where = request.input.string() + ": case '" + row.label + "', ";
    for (const double value : row.load.force) {
      statics::WarnIfImplausible(request, where + "force", value, 0, force, "N");
    }
    if (cases.direction == Direction::kInverse) {
      statics::WarnIfDegrees(request, where + "phi", row.given[1]);
      statics::WarnIfImplausible(request, where + "lambda_l", row.given[2], 0.3, 3, "");
      continue;
    }
    for (Eigen::Index i = 0; i < row.given.size(); ++i) {
      statics::WarnIfImplausible(request, where + "p" + std::to_string(i + 1), row.given[i],
                                 1e-3 * robot.module().E, 5 * robot.module().E, "Pa");
    }
  }
}

Names PressureColumns(const Robot& robot) {
  return statics::Numbered("p", static_cast<int>(robot.series.lines()));
}

Names SensitivityColumns(const Robot& robot, Direction direction) {
  const Names of = direction == Direction::kInverse ? PressureColumns(robot) : Names{"x", "y", "z"};
  Names names;
  for (const char* by : {"_dgamma", "_dE"}) {
    for (const std::string& name : of) names.push_back("d" + name + by);
  }
  return names;
}

void Append(Names& names, const Names& more) {
  names.insert(names.end(), more.begin(), more.end());
}

// Of every module in series: its upper end, and its section at the lower one.
constexpr const char* kOfModules[] = {"x_", "y_", "z_", "kappa_", "phi_", "lambda_l_"};

Names ModuleColumns(const Robot& robot) {
  Names names;
  const auto modules = static_cast<int>(robot.series.size());
  for (const char* prefix : kOfModules) Append(names, statics::Numbered(prefix, modules));
  return names;
}

Names Columns(const SolveRequest& request, const Robot& robot, Direction direction) {
  const auto lines = static_cast<int>(robot.module().lines.size());
  Names names = {"case"};
  if (direction == Direction::kInverse) Append(names, PressureColumns(robot));
  Append(names, Names{"x", "y", "z", "tx", "ty", "tz"});
  if (direction == Direction::kForward) Append(names, Names{"kappa", "phi", "lambda_l"});
  Append(names, Names{"r_o"});
  Append(names, statics::Numbered("r_G", lines));
  Append(names, statics::Numbered("gamma_e", lines));
  Append(names, Names{"x_in", "x_out", "residual", "iterations", "micros", "status"});
  for (const std::string& name : statics::StabilityColumns()) {
    if (direction == Direction::kForward || name == "why") names.push_back(name);
  }
  if (robot.series.size() > 1) Append(names, ModuleColumns(robot));
  if (request.sensitivity) Append(names, SensitivityColumns(robot, direction));
  if (!request.reach.empty()) {
    Append(names, PressureColumns(robot));
    Append(names, Names{"miss"});
  }
  if (!request.measured.empty()) {
    Append(names, statics::Numbered("error_", static_cast<int>(robot.series.size())));
  }
  Append(names, statics::DetailColumns{0, false, false, request.equilibria}.Names());
  return names;
}

void Set(statics::Results& results, const Names& columns, const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    results.Set(columns[i], values[static_cast<Eigen::Index>(i)]);
  }
}

// A row of the results.
struct Solved {
  Case row;
  Solution solution;
  std::vector<statics::Line> axes;  ///< of every module, for the picture
  int equilibrium = 0;              ///< of the case, counted from 1; 0: no list of them
  std::optional<double> miss = {};  ///< distance from a target [m]
  /// Distances of the modules' ends from those measured [m]; empty: no measurement.
  Eigen::VectorXd errors = {};
};

void WriteSection(const BaseSection& section, statics::Results& results) {
  results.Set("r_o", section.r_o);
  for (std::size_t i = 0; i < section.r_G.size(); ++i) {
    results.Set("r_G" + std::to_string(i + 1), section.r_G[i]);
    results.Set("gamma_e" + std::to_string(i + 1), section.gamma_e[i]);
  }
  results.Set("x_in", section.x_in);
  results.Set("x_out", section.x_out);
}

void WriteModules(const Robot& robot, const Method& method, const Solved& solved,
                  statics::Results& results) {
  const Eigen::Matrix3Xd ends = EndsOf(robot.series, method, solved.row, solved.solution);
  for (std::size_t j = 0; j < robot.series.size(); ++j) {
    const Axis<double>& at = solved.solution.bases[j];
    const Eigen::Vector3d end = ends.col(static_cast<Eigen::Index>(j));
    const double values[] = {
        end.x(),  end.y(), end.z(), std::hypot(at.k_1, at.k_2), std::atan2(at.k_2, at.k_1),
        at.lambda};
    for (std::size_t k = 0; k < std::size(values); ++k) {
      results.Set(kOfModules[k] + std::to_string(j + 1), values[k]);
    }
  }
}

void WriteRow(const SolveRequest& request, const Robot& robot, const Method& method,
              Direction direction, const Solved& solved, statics::Results& results) {
  const Solution& solution = solved.solution;
  const bool saddle = solution.status == Status::kOk && !solution.stability.stable();
  const bool missed = solved.miss && solution.outcome.status == numerics::Status::kOutOfDomain;
  const std::string status = saddle ? "saddle" : missed ? "out_of_reach" : Name(solution.status);
  results.Row();
  results.Set("case", solved.row.label);
  results.Set("status", status);
  results.Set("why", solution.outcome.why);
  if (solution.status != Status::kOk) return;
  if (direction == Direction::kForward) results.Set(solution.outcome, solution.stability);
  results.Set(solution.outcome, status);
  Set(results,
      direction == Direction::kInverse ? PressureColumns(robot) : Names{"kappa", "phi", "lambda_l"},
      solution.answer);
  Set(results, {"x", "y", "z"}, solution.tip);
  Set(results, {"tx", "ty", "tz"}, solution.tangent);
  WriteSection(solution.section, results);
  if (robot.series.size() > 1) WriteModules(robot, method, solved, results);
  if (solved.miss) {
    Set(results, PressureColumns(robot), solved.row.given);
    results.Set("miss", *solved.miss);
  }
  for (Eigen::Index i = 0; i < solved.errors.size(); ++i) {
    results.Set("error_" + std::to_string(i + 1), solved.errors[i]);
  }
  const auto details = Describe(robot.series, method, direction, solved.row, solution);
  Set(details, solved.equilibrium, results);
  if (!request.sensitivity) return;
  Eigen::VectorXd slopes(solution.by_gamma.size() + solution.by_E.size());
  slopes << solution.by_gamma, solution.by_E;
  Set(results, SensitivityColumns(robot, direction), slopes);
}

void Draw(const SolveRequest& request, const Robot& robot, Direction direction,
          const std::vector<Solved>& rows) {
  statics::Figure figure = EmptyFigure(robot.series);
  figure.title = "stiff_flop, module " + robot.name;
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk || solved.axes.empty()) continue;
    figure.shapes.push_back(
        ShapeOf(robot.series, direction, solved.row, solved.solution, solved.axes));
  }
  statics::WriteFigure(request.plot, figure);
}

void WriteShapes(const SolveRequest& request, const ModuleSeries& series, const Method& method,
                 const std::vector<Solved>& rows) {
  statics::ShapeTable table(0);
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk) continue;
    for (const auto& place : Places(series, method, solved.row, solved.solution)) {
      table.Add(solved.row.label, place);
    }
  }
  table.Write(request.shape);
}

void WriteCompliance(const SolveRequest& request, const ModuleSeries& series, const Method& method,
                     const std::vector<Solved>& rows) {
  statics::ComplianceTable table(0, false);
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk) continue;
    const auto response = Respond(series, method, solved.row, solved.solution);
    if (response) table.Add(solved.row.label, *response);
  }
  table.Write(request.compliance);
}

void WriteOutlines(OutlineTable& table, const ModuleSeries& series, const Method& method,
                   Direction direction, const std::vector<Solved>& rows) {
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk) continue;
    table.Add(series, method, direction, solved.row, solved.solution);
  }
  table.Write();
}

Solved SolveRow(const SolveRequest& request, const ModuleSeries& series, const Method& method,
                Direction direction, const Case& row) {
  const bool draw = !request.plot.empty();
  Solved solved{row, {}, {}};
  if (direction == Direction::kInverse) {
    solved.solution = SolveInverse(series.first(), method, row, request.sensitivity);
    if (draw && solved.solution.status == Status::kOk) {
      solved.axes = {InverseLine(series.first(), row)};
    }
  } else {
    solved.solution = SolveForward(series, method, row, request.sensitivity);
    if (draw) solved.axes = LinesOf(series, method, row, solved.solution);
  }
  return solved;
}

std::vector<Solved> SolveRows(const SolveRequest& request, const ModuleSeries& series,
                              const Method& method, const Cases& cases) {
  std::vector<Solved> solved(cases.rows.size());
  statics::ForRows(
      solved.size(), [](std::size_t) { return -1; },
      [&](std::size_t i) {
        solved[i] = SolveRow(request, series, method, cases.direction, cases.rows[i]);
      });
  return solved;
}

// The rows with the pressures that lead to their targets.
std::vector<Solved> ReachTargets(const SolveRequest& request, const ModuleSeries& series,
                                 const Method& method, const std::vector<Case>& rows) {
  std::vector<std::string> names;
  for (const Case& row : rows) names.push_back(row.label);
  const auto read =
      statics::ReadTargets(CsvTable::Read(request.reach), static_cast<int>(series.size()),
                           -std::numeric_limits<double>::infinity());
  const auto targets = statics::TargetsOf(read, names, request.reach.string());
  statics::PathError error;
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto reached = statics::LimitedSearch(
        kMostOfReach, [&] { return Reach(series, method, rows[i], targets[i]); });
    Solved s;
    s.row = rows[i];
    if (reached.outcome.ok()) {
      s.row.given = reached.drives;
      s = SolveRow(request, series, method, Direction::kForward, s.row);
      error.AtTarget(rows[i].label, reached.miss);
    } else {
      s.solution.outcome = reached.outcome;
      error.NotReached();
    }
    s.miss = reached.miss;
    solved.push_back(std::move(s));
  }
  request.say(error.Sentence());
  return solved;
}

// error_i of the modules' ends that were measured, and the table of these.
void AddErrors(const SolveRequest& request, const Robot& robot, const Method& method,
               std::vector<Solved>& rows) {
  if (request.measured.empty()) return;
  const auto modules = static_cast<int>(robot.series.size());
  const auto measured = statics::ReadMeasuredPoints(CsvTable::Read(request.measured), modules);
  Names names;
  for (const Solved& solved : rows) names.push_back(solved.row.label);
  statics::RequireShared(names, measured, request.measured.string());
  statics::ErrorTable errors(robot.series.length(), modules);
  for (Solved& solved : rows) {
    const auto* const m = statics::Find(measured, solved.row.label);
    if (m == nullptr || solved.solution.status != Status::kOk) continue;
    Eigen::Matrix3Xd ends = solved.solution.tip;
    if (modules > 1) ends = EndsOf(robot.series, method, solved.row, solved.solution);
    solved.errors = (m->disks - ends).colwise().norm().transpose();
    errors.Add(m->test, solved.errors);
  }
  statics::ReportErrors(request, errors, "stiff_flop, module " + robot.name);
}

// With --equilibria all of a case instead of its own answer, which is one of them.
void AddRows(const SolveRequest& request, const ModuleSeries& series, const Method& method,
             const Solved& own, std::vector<Solved>& rows) {
  if (request.equilibria) {
    int count = 0;
    for (Solution& s : Equilibria(series, method, own.row, own.solution)) {
      rows.push_back({own.row, std::move(s), own.axes, ++count});
    }
  }
  if (!request.equilibria || own.solution.status != Status::kOk) rows.push_back(own);
}

}  // namespace

int SolveStiffFlop(const SolveRequest& request) {
  RefuseOptions(request);
  const Robot robot = Robot::Read(request.robot);
  const ModuleSeries& series = robot.series;
  const Cases cases = Cases::Read(statics::CasesOf(request), robot);
  WarnOfImplausibleRobot(request, robot);
  WarnOfImplausibleCases(request, robot, cases);
  const Method method = Method::Parse(request.method, cases.direction);
  if (request.calibrate) return CalibrateRobot(request, robot, method, cases);
  statics::RequireExtension(request.out, {".csv", ".json"}, "--out");
  if (!request.plot.empty()) statics::RequireFigureEnding(request.plot);
  RefuseOfInverse(request, cases.direction);
  statics::CheckErrorOptions(request);
  statics::RequireTable(request.shape, "--shape");
  statics::RequireTable(request.compliance, "--compliance");
  std::optional<OutlineTable> outlines;
  if (!request.outlines.empty()) outlines.emplace(request.outlines);
  const std::vector<Solved> own = request.reach.empty()
                                      ? SolveRows(request, series, method, cases)
                                      : ReachTargets(request, series, method, cases.rows);
  std::vector<Solved> rows;
  for (const Solved& solved : own) AddRows(request, series, method, solved, rows);
  AddErrors(request, robot, method, rows);
  statics::Results results(Columns(request, robot, cases.direction));
  for (const Solved& solved : rows) {
    WriteRow(request, robot, method, cases.direction, solved, results);
  }
  statics::Write(results, request);
  if (!request.shape.empty()) WriteShapes(request, series, method, rows);
  if (!request.compliance.empty()) WriteCompliance(request, series, method, rows);
  if (outlines) WriteOutlines(*outlines, series, method, cases.direction, rows);
  if (!request.plot.empty()) Draw(request, robot, cases.direction, rows);
  const auto failed = [](const Solved& s) { return s.solution.status != Status::kOk; };
  return std::any_of(rows.begin(), rows.end(), failed) ? 1 : 0;
}

}  // namespace continuum
