#include "models/twin_pivot/solve.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <utility>

#include "error.h"
#include "models/statics/plausible.h"
#include "models/statics/results.h"
#include "models/statics/write_figure.h"
#include "models/twin_pivot/calibrate.h"
#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/figure.h"
#include "models/twin_pivot/twin_pivot.h"
#include "sim/io/file.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

using twin_pivot::Case;
using twin_pivot::Method;
using twin_pivot::Robot;
using twin_pivot::Solution;

void RefuseOptions(const SolveRequest& request) {
  const std::initializer_list<std::pair<const char*, bool>> foreign = {
      {"--hybrid", !request.hybrid.empty()},
      {"--lambda", request.lambda.has_value()},
      {"--cross-validate", request.cross_validate},
      {"--sensitivity", request.sensitivity},
      {"--measured", !request.measured.empty()},
      {"--plot with --calibrate", request.calibrate && !request.plot.empty()},
      {"--method with --calibrate", request.calibrate && !request.method.empty()}};
  for (const auto& [option, given] : foreign) {
    if (given) throw Error::Input(option, "no such option for a twin_pivot robot");
  }
  if (request.input.empty()) throw Error::Input("--input", "a CSV file", "nothing");
}

Method ReadMethod(const std::string& name) {
  if (name.empty() || name == "virtual_work") return Method::kVirtualWork;
  if (name == "printed") return Method::kPrinted;
  throw Error::Input("--method", "virtual_work or printed", "'" + name + "'");
}

int Calibrate(const SolveRequest& request) {
  statics::RequireExtension(request.out, {".json"}, "--out");
  WriteFile(request.out, twin_pivot::CalibrateFriction(request.input).Json());
  return 0;
}

void WarnOfImplausibleRobot(const SolveRequest& request, const Robot& robot) {
  const Yaml file = Yaml::Read(request.robot);
  const auto check = [&](const char* key, double value, double low, double high, const char* unit) {
    statics::WarnIfImplausible(request, file.At(key).Where(), value, low, high, unit);
  };
  const double pitch = robot.L + robot.h;
  check("L", robot.L, 1e-4, 0.5, "m");
  check("h", robot.h, 1e-5, 0.5, "m");
  check("E", robot.E, 1e6, 1e12, "Pa");
  check("I_z", robot.I_z, 1e-20, 1e-6, "m^4");
  check("m_D", robot.m_D, 1e-7, 5, "kg");
  check("m_NiTi", robot.m_NiTi, 1e-8, 5, "kg");
  check("rho_cable", robot.rho_cable, 1e-7, 5, "kg/m");
  check("m_CL", robot.m_CL, 1e-8, 5, "kg");
  check("gravity", robot.gravity.norm(), 0.1, 100, "m/s^2");
  for (const double r : robot.r) check("r", r, pitch / 100, 5 * pitch, "m");
  for (const double phi : robot.phi) {
    statics::WarnIfDegrees(request, file.At("phi").Where(), phi);
  }
}

// A tension is judged by the angle that it alone would bend a joint by.
void WarnOfImplausibleTensions(const SolveRequest& request, const Robot& robot,
                               const std::vector<Case>& cases) {
  constexpr double kMostBend = 3;  // rad in one joint
  for (const Case& row : cases) {
    for (std::size_t j = 0; j < row.load.tension.size(); ++j) {
      statics::WarnIfImplausible(
          request,
          request.input.string() + ": case '" + row.label + "', cable " + std::to_string(j + 1),
          row.load.tension[j], 0, kMostBend * robot.Stiffness() / robot.r[j], "N");
    }
  }
}

std::vector<Solution> SolveCases(const Robot& robot, const std::vector<Case>& cases,
                                 Method method) {
  std::vector<Solution> solved;
  for (const Case& row : cases) {
    if (row.reference < 0) {
      solved.push_back(twin_pivot::Solve(robot, row.load, method));
      continue;
    }
    const Solution from = solved[row.reference];
    const Case& earlier = cases[row.reference];
    if (from.outcome.ok()) {
      solved.push_back(twin_pivot::SolveFrom(robot, earlier.load, from, row.load, method));
    } else {
      solved.emplace_back();
      solved.back().outcome.why = "its reference '" + earlier.label + "' failed";
    }
  }
  return solved;
}

void WriteRow(const Robot& robot, const Case& row, const Solution& solution,
              statics::Results& results) {
  results.Row();
  results.Set("case", row.label);
  results.Set("condition",
              std::string(twin_pivot::kConditions[static_cast<int>(row.load.condition)]));
  results.Set(solution.outcome, solution.outcome.ok() ? "ok" : "no_convergence");
  results.Set(solution.outcome, solution.stability);
  if (!solution.outcome.ok()) return;
  for (int i = 0; i < 3; ++i) results.Set(std::string(1, "xyz"[i]), solution.tip[i]);
  for (int m = 0; m < robot.Joints(); ++m) {
    results.Set("beta_" + std::to_string(m + 1), solution.beta[m]);
  }
  for (int j = 0; j < robot.Cables(); ++j) {
    results.Set("F_end_" + std::to_string(j + 1), solution.tension(robot.Anchor(j) - 1, j));
  }
}

void WriteResults(const SolveRequest& request, const Robot& robot, const std::vector<Case>& cases,
                  const std::vector<Solution>& solved) {
  std::vector<std::string> columns = {"case",   "condition", "status", "iterations", "residual",
                                      "micros", "x",         "y",      "z"};
  for (const std::string& name : statics::StabilityColumns()) columns.push_back(name);
  for (const auto& [prefix, count] :
       {std::pair{"beta_", robot.Joints()}, std::pair{"F_end_", robot.Cables()}}) {
    for (const std::string& name : statics::Numbered(prefix, count)) columns.push_back(name);
  }
  statics::Results results(columns);
  for (std::size_t i = 0; i < cases.size(); ++i) WriteRow(robot, cases[i], solved[i], results);
  results.Write(request.out);
}

void Draw(const SolveRequest& request, const Robot& robot, const std::vector<Case>& cases,
          const std::vector<Solution>& solved) {
  statics::Figure figure = twin_pivot::EmptyFigure(robot);
  figure.title = "twin_pivot: " + request.robot.filename().string();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!solved[i].outcome.ok()) continue;
    figure.shapes.push_back(twin_pivot::ShapeOf(robot, cases[i].load, solved[i]));
    figure.shapes.back().label = cases[i].label;
  }
  statics::WriteFigure(request.plot, figure);
}

}  // namespace

int SolveTwinPivot(const SolveRequest& request) {
  RefuseOptions(request);
  const Robot robot = Robot::Read(request.robot);
  WarnOfImplausibleRobot(request, robot);
  if (request.calibrate) return Calibrate(request);
  const Method method = ReadMethod(request.method);
  statics::RequireExtension(request.out, {".csv", ".json"}, "--out");
  if (!request.plot.empty()) statics::RequireFigureEnding(request.plot);
  const std::vector<Case> cases = twin_pivot::ReadCases(request.input, robot);
  WarnOfImplausibleTensions(request, robot, cases);
  const std::vector<Solution> solved = SolveCases(robot, cases, method);
  WriteResults(request, robot, cases, solved);
  if (!request.plot.empty()) Draw(request, robot, cases, solved);
  for (const Solution& solution : solved) {
    if (!solution.outcome.ok()) return 1;
  }
  return 0;
}

}  // namespace continuum
