#include "models/tdcr/solved.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "models/statics/details.h"
#include "models/statics/error_table.h"
#include "models/statics/results.h"
#include "models/statics/shape_table.h"
#include "models/statics/write_figure.h"
#include "models/tdcr/details.h"
#include "models/tdcr/figure.h"
#include "models/tdcr/inputs.h"
#include "models/tdcr/line.h"
#include "models/tdcr/response.h"

namespace continuum::tdcr {
namespace {

void Append(const std::vector<std::string>& more, std::vector<std::string>& columns) {
  columns.insert(columns.end(), more.begin(), more.end());
}

std::vector<std::string> Columns(const SolveRequest& request, const Robot& robot, bool by_length) {
  const int disks = robot.disks;
  std::vector<std::string> columns{"case",   "status", "iterations", "residual",
                                   "micros", "x",      "y",          "z"};
  Append(statics::StabilityColumns(), columns);
  for (int i = 1; i <= disks; ++i) {
    for (const char* axis : {"x", "y", "z"}) columns.push_back(fmt::format("{}_{}", axis, i));
  }
  for (int i = 1; i <= disks; ++i) {
    for (const char* u : {"kappa_x", "kappa_y", "tau"})
      columns.push_back(fmt::format("{}_{}", u, i));
  }
  if (request.method == "fit") return columns;
  const bool reaches = !request.reach.empty();
  Append(statics::DetailColumns{robot.tendons, by_length, reaches, request.equilibria}.Names(),
         columns);
  if (by_length && reaches) Append(statics::Numbered("L", robot.tendons), columns);
  return columns;
}

// error_i of every disk that was measured in some case.
void AddErrorColumns(const std::vector<Solved>& solved, int disks,
                     std::vector<std::string>& columns) {
  for (int i = 0; i < disks; ++i) {
    for (const Solved& s : solved) {
      if (s.measured == nullptr || !s.measured->Has(i)) continue;
      columns.push_back(fmt::format("error_{}", i + 1));
      break;
    }
  }
}

// within_i of every disk that calibration has measured.
void AddWithinColumns(const Prediction& prediction, std::vector<std::string>& columns) {
  for (std::size_t i = 0; i < prediction.within.size(); ++i) {
    if (!std::isnan(prediction.within[i])) columns.push_back(fmt::format("within_{}", i + 1));
  }
}

void SetWithin(const Prediction& prediction, statics::Results& results) {
  for (std::size_t i = 0; i < prediction.within.size(); ++i) {
    const double within = prediction.within[i];
    if (!std::isnan(within)) results.Set(fmt::format("within_{}", i + 1), within);
  }
}

void AddShape(const Robot& robot, const Solved& s, statics::Results& results) {
  const char* const axes[3] = {"x", "y", "z"};
  const char* const curvatures[3] = {"kappa_x", "kappa_y", "tau"};
  const Solution& solution = s.solution;
  for (int a = 0; a < 3; ++a) results.Set(axes[a], solution.disks(a, robot.disks - 1));
  for (int i = 0; i < robot.disks; ++i) {
    for (int a = 0; a < 3; ++a) {
      results.Set(fmt::format("{}_{}", axes[a], i + 1), solution.disks(a, i));
      results.Set(fmt::format("{}_{}", curvatures[a], i + 1), solution.u(a, i));
    }
  }
  if (s.measured == nullptr) return;
  const Eigen::VectorXd errors = Errors(robot, *s.measured, solution.disks);
  for (int i = 0; i < robot.disks; ++i) {
    if (s.measured->Has(i)) results.Set(fmt::format("error_{}", i + 1), errors[i]);
  }
}

void Draw(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& solved) {
  statics::Figure figure = EmptyFigure(robot);
  figure.title = "tdcr " + MethodName(request, robot);
  for (const Solved& s : solved) {
    if (!s.solution.outcome.ok()) continue;
    figure.shapes.push_back(ShapeOf(robot, s.loads, s.solution, s.measured));
    figure.shapes.back().label = s.name;
  }
  statics::WriteFigure(request.plot, figure);
}

Method MethodOf(const SolveRequest& request, const Robot& robot) {
  return ParseMethod(MethodName(request, robot));
}

void WriteShapes(const SolveRequest& request, const Robot& robot,
                 const std::vector<Solved>& solved) {
  statics::ShapeTable table(robot.tendons);
  for (const Solved& s : solved) {
    if (!s.solution.outcome.ok()) continue;
    const Line line = LineOf(robot, s.loads, MethodOf(request, robot), s.solution);
    for (Eigen::Index i = 0; i < line.s.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      table.Add(s.name, {line.s[i], line.disk[at], line.points.col(i), line.frames[at],
                         line.tension.row(i)});
    }
  }
  table.Write(request.shape);
}

void WriteCompliance(const SolveRequest& request, const Robot& robot,
                     const std::vector<Solved>& solved) {
  const bool by_length = !solved.empty() && solved.front().loads.length.size() > 0;
  statics::ComplianceTable table(robot.tendons, by_length);
  for (const Solved& s : solved) {
    if (!s.solution.outcome.ok()) continue;
    const auto response = Respond(robot, s.loads, MethodOf(request, robot), s.solution);
    if (response) table.Add(s.name, *response);
  }
  table.Write(request.compliance);
}

// Distances from what was measured.
void AddErrors(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& solved) {
  statics::ErrorTable errors(robot.length, robot.disks);
  for (const Solved& s : solved) {
    if (s.measured == nullptr || !s.solution.outcome.ok()) continue;
    errors.Add(s.measured->test, Errors(robot, *s.measured, s.solution.disks));
  }
  statics::ReportErrors(request, errors, "tdcr " + MethodName(request, robot));
}

}  // namespace

int Report(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& solved,
           const std::optional<Prediction>& prediction) {
  const bool by_length = !solved.empty() && solved.front().loads.length.size() > 0;
  auto columns = Columns(request, robot, by_length);
  AddErrorColumns(solved, robot.disks, columns);
  if (prediction) AddWithinColumns(*prediction, columns);
  const auto failed = [](const Solved& s) { return !s.solution.outcome.ok(); };
  const bool all = std::none_of(solved.begin(), solved.end(), failed);
  statics::Results results(columns);
  for (const Solved& s : solved) {
    const bool ok = s.solution.outcome.ok();
    results.Row();
    results.Set("case", s.name);
    const bool missed = s.miss && s.solution.outcome.status == numerics::Status::kOutOfDomain;
    results.Set(
        s.solution.outcome,
        missed ? "out_of_reach" : statics::StatusOf(s.solution.outcome, s.solution.stability));
    if (ok) AddShape(robot, s, results);
    if (ok && prediction) SetWithin(*prediction, results);
    if (request.method == "fit") {
      results.Set("why", s.solution.outcome.why);
      continue;
    }
    results.Set(s.solution.outcome, s.solution.stability);
    if (!ok) continue;
    auto details = Describe(robot, s.loads, MethodOf(request, robot), s.solution);
    details.miss = s.miss;
    Set(details, s.equilibrium, results);
    if (s.miss) statics::SetEach("L", s.loads.length, results);
  }
  statics::Write(results, request);
  if (!request.shape.empty()) WriteShapes(request, robot, solved);
  if (!request.compliance.empty()) WriteCompliance(request, robot, solved);
  if (!request.plot.empty()) Draw(request, robot, solved);
  AddErrors(request, robot, solved);
  return all ? 0 : 1;
}

}  // namespace continuum::tdcr
