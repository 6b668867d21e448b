#include "models/stiff_flop/solve.h"

#include <fmt/format.h>

#include <initializer_list>
#include <utility>

#include "error.h"
#include "models/statics/plausible.h"
#include "models/statics/results.h"
#include "models/statics/write_figure.h"
#include "models/stiff_flop/figure.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

using namespace stiff_flop;

using Names = std::vector<std::string>;

void RefuseOptions(const SolveRequest& request) {
  const std::initializer_list<std::pair<const char*, bool>> foreign = {
      {"--calibrate", request.calibrate},
      {"--hybrid", !request.hybrid.empty()},
      {"--lambda", request.lambda.has_value()},
      {"--cross-validate", request.cross_validate},
      {"--measured", !request.measured.empty()}};
  for (const auto& [option, given] : foreign) {
    if (given) throw Error::Input(option, "no such option for a stiff_flop robot");
  }
  if (request.input.empty()) throw Error::Input("--input", "a CSV file", "nothing");
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

Names Columns(Direction direction, bool sensitivity) {
  Names names = {"case"};
  if (direction == Direction::kInverse) Append(names, {"p1", "p2", "p3"});
  Append(names, {"x", "y", "z", "tx", "ty", "tz"});
  if (direction == Direction::kForward) Append(names, {"kappa", "phi", "lambda_l"});
  Append(names, {"r_o", "r_G1", "r_G2", "r_G3", "gamma_e1", "gamma_e2", "gamma_e3", "x_in", "x_out",
                 "residual", "iterations", "micros", "status"});
  for (const std::string& name : statics::StabilityColumns()) {
    if (direction == Direction::kForward || name == "why") names.push_back(name);
  }
  if (sensitivity) {
    const Names more = SensitivityColumns(direction);
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

void Set(statics::Results& results, const Names& columns, const Eigen::Vector3d& values) {
  for (int i = 0; i < 3; ++i) results.Set(columns[i], values[i]);
}

void WriteRow(const Case& row, Direction direction, bool sensitivity, const Solution& solution,
              statics::Results& results) {
  results.Row();
  results.Set("case", row.label);
  results.Set("status", Name(solution.status));
  results.Set("why", solution.outcome.why);
  if (solution.status != Status::kOk) return;
  if (direction == Direction::kForward) results.Set(solution.outcome, solution.stability);
  results.Set(solution.outcome, Name(solution.status));
  Set(results,
      direction == Direction::kInverse ? Names{"p1", "p2", "p3"}
                                       : Names{"kappa", "phi", "lambda_l"},
      solution.answer);
  Set(results, {"x", "y", "z"}, solution.tip);
  Set(results, {"tx", "ty", "tz"}, solution.tangent);
  const BaseSection& section = solution.section;
  results.Set("r_o", section.r_o);
  for (int i = 0; i < 3; ++i) {
    results.Set("r_G" + std::to_string(i + 1), section.r_G[i]);
    results.Set("gamma_e" + std::to_string(i + 1), section.gamma_e[i]);
  }
  results.Set("x_in", section.x_in);
  results.Set("x_out", section.x_out);
  if (!sensitivity) return;
  const Names names = SensitivityColumns(direction);
  Set(results, {names.begin(), names.begin() + 3}, solution.by_gamma);
  Set(results, {names.begin() + 3, names.end()}, solution.by_E);
}

void Draw(const SolveRequest& request, const Robot& robot, const Cases& cases,
          const std::vector<Solution>& solved,
          const std::vector<std::vector<Eigen::Vector3d>>& lines) {
  statics::Figure figure = EmptyFigure(robot.module);
  figure.title = "stiff_flop, module " + robot.name;
  for (std::size_t i = 0; i < cases.rows.size(); ++i) {
    if (solved[i].status != Status::kOk) continue;
    figure.shapes.push_back(
        ShapeOf(robot.module, cases.direction, cases.rows[i], solved[i], lines[i]));
  }
  statics::WriteFigure(request.plot, figure);
}

}  // namespace

int SolveStiffFlop(const SolveRequest& request) {
  RefuseOptions(request);
  const Robot robot = Robot::Read(request.robot);
  const Cases cases = Cases::Read(request.input, robot.gravity);
  WarnOfTubesOutsideTheWall(request, robot);
  WarnOfImplausibleRobot(request, robot);
  WarnOfImplausibleCases(request, robot, cases);
  const Method method = Method::Parse(request.method, cases.direction);
  statics::RequireExtension(request.out, {".csv", ".json"}, "--out");
  if (!request.plot.empty()) statics::RequireFigureEnding(request.plot);
  std::vector<Solution> solved;
  statics::Results results(Columns(cases.direction, request.sensitivity));
  int failed = 0;
  const bool draw = !request.plot.empty();
  std::vector<std::vector<Eigen::Vector3d>> lines(draw ? cases.rows.size() : 0);
  for (std::size_t i = 0; i < cases.rows.size(); ++i) {
    const Case& row = cases.rows[i];
    if (cases.direction == Direction::kInverse) {
      solved.push_back(SolveInverse(robot.module, method, row, request.sensitivity));
      if (draw && solved.back().status == Status::kOk) lines[i] = InverseLine(robot.module, row);
    } else {
      solved.push_back(
          SolveForward(robot.module, method, row, request.sensitivity, draw ? &lines[i] : nullptr));
    }
    WriteRow(row, cases.direction, request.sensitivity, solved.back(), results);
    failed += solved.back().status != Status::kOk;
  }
  results.Write(request.out);
  if (draw) Draw(request, robot, cases, solved, lines);
  return failed == 0 ? 0 : 1;
}

}  // namespace continuum
