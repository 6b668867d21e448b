#include "models/stiff_flop/solve.h"

#include <fmt/format.h>

#include <initializer_list>
#include <limits>
#include <optional>
#include <utility>

#include "error.h"
#include "models/statics/details.h"
#include "models/statics/error_table.h"
#include "models/statics/measured_points.h"
#include "models/statics/path_error.h"
#include "models/statics/plausible.h"
#include "models/statics/results.h"
#include "models/statics/rows.h"
#include "models/statics/sweep.h"
#include "models/statics/write_figure.h"
#include "models/stiff_flop/cases.h"
#include "models/stiff_flop/details.h"
#include "models/stiff_flop/equilibria.h"
#include "models/stiff_flop/figure.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"
#include "models/stiff_flop/learn.h"
#include "models/stiff_flop/reach.h"
#include "models/stiff_flop/response.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

using namespace stiff_flop;

using Names = std::vector<std::string>;

void RefuseOptions(const SolveRequest& request) {
  const std::initializer_list<std::pair<const char*, bool>> foreign = {
      {"--equilibria with --calibrate", request.calibrate && request.equilibria},
      {"--shape with --calibrate", request.calibrate && !request.shape.empty()},
      {"--compliance with --calibrate", request.calibrate && !request.compliance.empty()},
      {"--plot with --calibrate", request.calibrate && !request.plot.empty()},
      {"--reach with --calibrate", request.calibrate && !request.reach.empty()},
      {"--errors with --calibrate", request.calibrate && !request.errors.empty()},
      {"--boxplot with --calibrate", request.calibrate && !request.boxplot.empty()},
      {"--sensitivity with --calibrate", request.calibrate && request.sensitivity},
      {"--parameters without --calibrate", !request.calibrate && !request.parameters.empty()},
      {"--hybrid", !request.hybrid.empty()},
      {"--lambda", request.lambda.has_value()},
      {"--cross-validate", request.cross_validate},
      {"--follow", !request.follow.empty()},
      {"--reach with --equilibria", request.equilibria && !request.reach.empty()},
      {"--measured with --equilibria", request.equilibria && !request.measured.empty()}};
  for (const auto& [option, given] : foreign) {
    if (given) throw Error::Input(option, "no such option for a stiff_flop robot");
  }
  if (request.input.empty()) throw Error::Input("--input", "a CSV file", "nothing");
}

// --equilibria, --shape, --compliance and --reach are of the forward model, whose shape is not
// given.
void RefuseOfInverse(const SolveRequest& request, Direction direction) {
  if (direction == Direction::kForward) return;
  if (request.equilibria) throw Error::Input("--equilibria", "cases with p1, p2, p3", "kappa");
  if (!request.shape.empty()) throw Error::Input("--shape", "cases with p1, p2, p3", "kappa");
  if (!request.compliance.empty())
    throw Error::Input("--compliance", "cases with p1, p2, p3", "kappa");
  if (!request.reach.empty()) throw Error::Input("--reach", "cases with p1, p2, p3", "kappa");
}

void Append(Names& names, std::initializer_list<const char*> more) {
  names.insert(names.end(), more.begin(), more.end());
}

// The radius where it is a diameter, for one.
void WarnOfTubesOutsideTheWall(const SolveRequest& request, const Robot& robot) {
  const Module& m = robot.module;
  if (m.r_o + m.r_c2 <= m.r_2 && m.r_o - m.r_c2 >= m.r_1) return;
  const Yaml r_o = Yaml::Read(request.robot).At("modules").At(robot.name).At("r_o");
  request.warn(
      fmt::format("{}: tubes from {:.3g} to {:.3g} m, not within the wall, {:.3g} to {:.3g} m",
                  r_o.Where(), m.r_o - m.r_c2, m.r_o + m.r_c2, m.r_1, m.r_2));
}

void WarnOfImplausibleRobot(const SolveRequest& request, const Robot& robot) {
  const Yaml file = Yaml::Read(request.robot);
  const Yaml module = file.At("modules").At(robot.name);
  const auto check = [&](const char* key, double value, double low, double high, const char* unit) {
    statics::WarnIfImplausible(request, module.At(key).Where(), value, low, high, unit);
  };
  const Module& m = robot.module;
  check("r_2", m.r_2, 1e-3, 0.5, "m");
  check("l", m.l, m.r_2 / 2, 5, "m");
  check("l_fs", m.l_fs, 0, 5 * m.l, "m");
  check("E", m.E, 1e3, 1e9, "Pa");
  check("m", m.m, 1e-5, 20, "kg");
  check("m_fs", m.m_fs, 1e-6, 20, "kg");
  statics::WarnIfImplausible(request, file.At("gravity").Where(), robot.gravity.norm(), 0.1, 100,
                             "m/s^2");
}

// Pressures are judged by E, forces by what lengthens the body to twice its length.
void WarnOfImplausibleCases(const SolveRequest& request, const Robot& robot, const Cases& cases) {
  const double force = robot.module.E * robot.module.Area();
  for (const Case& row : cases.rows) {
    const std::string where = request.input.string() + ": case '" + row.label + "', ";
    for (int i = 0; i < 3; ++i) {
      statics::WarnIfImplausible(request, where + "force", row.load.force[i], 0, force, "N");
      if (cases.direction == Direction::kInverse) continue;
      statics::WarnIfImplausible(request, where + "p" + std::to_string(i + 1), row.given[i], 0,
                                 5 * robot.module.E, "Pa");
    }
    if (cases.direction == Direction::kInverse) {
      statics::WarnIfDegrees(request, where + "phi", row.given[1]);
    }
  }
}

Names SensitivityColumns(Direction direction) {
  if (direction == Direction::kInverse) {
    return {"dp1_dgamma", "dp2_dgamma", "dp3_dgamma", "dp1_dE", "dp2_dE", "dp3_dE"};
  }
  return {"dx_dgamma", "dy_dgamma", "dz_dgamma", "dx_dE", "dy_dE", "dz_dE"};
}

void Append(Names& names, const Names& more) {
  names.insert(names.end(), more.begin(), more.end());
}

Names Columns(const SolveRequest& request, Direction direction) {
  Names names = {"case"};
  if (direction == Direction::kInverse) Append(names, {"p1", "p2", "p3"});
  Append(names, {"x", "y", "z", "tx", "ty", "tz"});
  if (direction == Direction::kForward) Append(names, {"kappa", "phi", "lambda_l"});
  Append(names, {"r_o", "r_G1", "r_G2", "r_G3", "gamma_e1", "gamma_e2", "gamma_e3", "x_in", "x_out",
                 "residual", "iterations", "micros", "status"});
  for (const std::string& name : statics::StabilityColumns()) {
    if (direction == Direction::kForward || name == "why") names.push_back(name);
  }
  if (request.sensitivity) Append(names, SensitivityColumns(direction));
  if (!request.reach.empty()) Append(names, {"p1", "p2", "p3", "miss"});
  if (!request.measured.empty()) Append(names, {"error_1"});
  Append(names, statics::DetailColumns{0, false, false, request.equilibria}.Names());
  return names;
}

void Set(statics::Results& results, const Names& columns, const Eigen::Vector3d& values) {
  for (int i = 0; i < 3; ++i) results.Set(columns[i], values[i]);
}

// A row of the results.
struct Solved {
  Case row;
  Solution solution;
  std::vector<Eigen::Vector3d> line;  ///< for the picture
  int equilibrium = 0;                ///< of the case, counted from 1; 0: no list of them
  std::optional<double> miss = {};    ///< distance from a target [m]
  std::optional<double> error = {};   ///< distance from the measured tip [m]
};

void WriteSection(const BaseSection& section, statics::Results& results) {
  results.Set("r_o", section.r_o);
  for (int i = 0; i < 3; ++i) {
    results.Set("r_G" + std::to_string(i + 1), section.r_G[i]);
    results.Set("gamma_e" + std::to_string(i + 1), section.gamma_e[i]);
  }
  results.Set("x_in", section.x_in);
  results.Set("x_out", section.x_out);
}

void WriteRow(const SolveRequest& request, const Module& module, const Method& method,
              Direction direction, const Solved& solved, statics::Results& results) {
  const Solution& solution = solved.solution;
  const bool saddle = !solution.stability.stable();
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
      direction == Direction::kInverse ? Names{"p1", "p2", "p3"}
                                       : Names{"kappa", "phi", "lambda_l"},
      solution.answer);
  Set(results, {"x", "y", "z"}, solution.tip);
  Set(results, {"tx", "ty", "tz"}, solution.tangent);
  WriteSection(solution.section, results);
  if (solved.miss) {
    Set(results, {"p1", "p2", "p3"}, solved.row.given);
    results.Set("miss", *solved.miss);
  }
  if (solved.error) results.Set("error_1", *solved.error);
  const auto details = Describe(module, method, direction, solved.row, solution);
  Set(details, solved.equilibrium, results);
  if (!request.sensitivity) return;
  const Names names = SensitivityColumns(direction);
  Set(results, {names.begin(), names.begin() + 3}, solution.by_gamma);
  Set(results, {names.begin() + 3, names.end()}, solution.by_E);
}

void Draw(const SolveRequest& request, const Robot& robot, Direction direction,
          const std::vector<Solved>& rows) {
  statics::Figure figure = EmptyFigure(robot.module);
  figure.title = "stiff_flop, module " + robot.name;
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk || solved.line.empty()) continue;
    figure.shapes.push_back(
        ShapeOf(robot.module, direction, solved.row, solved.solution, solved.line));
  }
  statics::WriteFigure(request.plot, figure);
}

void WriteShapes(const SolveRequest& request, const Module& module, const Method& method,
                 const std::vector<Solved>& rows) {
  statics::ShapeTable table(0);
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk) continue;
    for (const auto& place : Places(module, method, solved.row, solved.solution)) {
      table.Add(solved.row.label, place);
    }
  }
  table.Write(request.shape);
}

void WriteCompliance(const SolveRequest& request, const Module& module, const Method& method,
                     const std::vector<Solved>& rows) {
  statics::ComplianceTable table(0, false);
  for (const Solved& solved : rows) {
    if (solved.solution.status != Status::kOk) continue;
    const auto response = Respond(module, method, solved.row, solved.solution);
    if (response) table.Add(solved.row.label, *response);
  }
  table.Write(request.compliance);
}

Solved SolveRow(const SolveRequest& request, const Module& module, const Method& method,
                Direction direction, const Case& row) {
  const bool draw = !request.plot.empty();
  Solved solved{row, {}, {}};
  if (direction == Direction::kInverse) {
    solved.solution = SolveInverse(module, method, row, request.sensitivity);
    if (draw && solved.solution.status == Status::kOk) solved.line = InverseLine(module, row);
  } else {
    solved.solution =
        SolveForward(module, method, row, request.sensitivity, draw ? &solved.line : nullptr);
  }
  return solved;
}

std::vector<Solved> SolveRows(const SolveRequest& request, const Module& module,
                              const Method& method, const Cases& cases) {
  std::vector<Solved> solved(cases.rows.size());
  statics::ForRows(
      solved.size(), [](std::size_t) { return -1; },
      [&](std::size_t i) {
        solved[i] = SolveRow(request, module, method, cases.direction, cases.rows[i]);
      });
  return solved;
}

// The rows with the pressures that lead to their targets.
std::vector<Solved> ReachTargets(const SolveRequest& request, const Module& module,
                                 const Method& method, const std::vector<Case>& rows) {
  std::vector<std::string> names;
  for (const Case& row : rows) names.push_back(row.label);
  const auto read = statics::ReadTargets(CsvTable::Read(request.reach), 1,
                                         -std::numeric_limits<double>::infinity());
  const auto targets = statics::TargetsOf(read, names, request.reach.string());
  statics::PathError error;
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto reached = Reach(module, method, rows[i], targets[i]);
    Solved s;
    s.row = rows[i];
    if (reached.outcome.ok()) {
      s.row.given = reached.drives;
      s = SolveRow(request, module, method, Direction::kForward, s.row);
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

// error_1 (of the tip) where it was measured, and the table of these.
void AddErrors(const SolveRequest& request, const Robot& robot, std::vector<Solved>& rows) {
  if (request.measured.empty()) return;
  const auto measured = statics::ReadMeasuredPoints(CsvTable::Read(request.measured), 1);
  Names names;
  for (const Solved& solved : rows) names.push_back(solved.row.label);
  statics::RequireShared(names, measured, request.measured.string());
  statics::ErrorTable errors(robot.module.l, 1);
  for (Solved& solved : rows) {
    const auto* const m = statics::Find(measured, solved.row.label);
    if (m == nullptr || solved.solution.status != Status::kOk) continue;
    solved.error = (m->disks.col(0) - solved.solution.tip).norm();
    errors.Add(m->test, Eigen::VectorXd::Constant(1, *solved.error));
  }
  statics::ReportErrors(request, errors, "stiff_flop, module " + robot.name);
}

// With --equilibria all of a case instead of its own answer, which is one of them.
void AddRows(const SolveRequest& request, const Module& module, const Method& method,
             const Solved& own, std::vector<Solved>& rows) {
  if (request.equilibria) {
    int count = 0;
    for (Solution& s : Equilibria(module, method, own.row, own.solution)) {
      rows.push_back({own.row, std::move(s), own.line, ++count});
    }
  }
  if (!request.equilibria || own.solution.status != Status::kOk) rows.push_back(own);
}

}  // namespace

int SolveStiffFlop(const SolveRequest& request) {
  RefuseOptions(request);
  const Robot robot = Robot::Read(request.robot);
  const Cases cases = ReadCases(statics::CasesOf(request), robot.gravity);
  WarnOfTubesOutsideTheWall(request, robot);
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
  const std::vector<Solved> own = request.reach.empty()
                                      ? SolveRows(request, robot.module, method, cases)
                                      : ReachTargets(request, robot.module, method, cases.rows);
  std::vector<Solved> rows;
  int failed = 0;
  for (const Solved& solved : own) {
    failed += solved.solution.status != Status::kOk;
    AddRows(request, robot.module, method, solved, rows);
  }
  AddErrors(request, robot, rows);
  statics::Results results(Columns(request, cases.direction));
  for (const Solved& solved : rows) {
    WriteRow(request, robot.module, method, cases.direction, solved, results);
  }
  statics::Write(results, request);
  if (!request.shape.empty()) WriteShapes(request, robot.module, method, rows);
  if (!request.compliance.empty()) WriteCompliance(request, robot.module, method, rows);
  if (!request.plot.empty()) Draw(request, robot, cases.direction, rows);
  return failed == 0 ? 0 : 1;
}

}  // namespace continuum
