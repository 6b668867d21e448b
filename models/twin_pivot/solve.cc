#include "models/twin_pivot/solve.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/details.h"
#include "models/statics/error_table.h"
#include "models/statics/foreign_options.h"
#include "models/statics/limited_search.h"
#include "models/statics/measured_points.h"
#include "models/statics/path_error.h"
#include "models/statics/results.h"
#include "models/statics/rows.h"
#include "models/statics/sweep.h"
#include "models/statics/write_figure.h"
#include "models/twin_pivot/calibrate.h"
#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/details.h"
#include "models/twin_pivot/equilibria.h"
#include "models/twin_pivot/figure.h"
#include "models/twin_pivot/follow.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/limits.h"
#include "models/twin_pivot/plausible.h"
#include "models/twin_pivot/reach.h"
#include "models/twin_pivot/response.h"
#include "models/twin_pivot/twin_pivot.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

using twin_pivot::Case;
using twin_pivot::Method;
using twin_pivot::Robot;
using twin_pivot::Solution;

void RefuseOptions(const SolveRequest& request) {
  const bool follows = !request.follow.empty();
  statics::RefuseForeignOptions(
      request, "twin_pivot",
      {{"--hybrid", !request.hybrid.empty()},
       {"--lambda", request.lambda.has_value()},
       {"--cross-validate", request.cross_validate},
       {"--sensitivity", request.sensitivity},
       {"--outlines", !request.outlines.empty()},
       {"--parameters", !request.parameters.empty()},
       {"--sweep with --calibrate", request.calibrate && request.sweep != 0},
       {"--measured with --calibrate", request.calibrate && !request.measured.empty()},
       {"--method with --calibrate", request.calibrate && !request.method.empty()},
       {"--measured with --follow", follows && !request.measured.empty()},
       {"--follow with --equilibria", follows && request.equilibria},
       {"--follow with --reach", follows && !request.reach.empty()},
       {"--follow with --sweep", follows && request.sweep != 0}});
}

int Calibrate(const SolveRequest& request) {
  statics::RequireExtension(request.out, {".json"}, "--out");
  WriteFile(request.out, twin_pivot::CalibrateFriction(request.input).Json());
  return 0;
}

// A row of the results.
struct Solved {
  Case row;
  Solution solution;
  int equilibrium = 0;              ///< of the case, counted from 1; 0: no list of them
  std::optional<double> miss = {};  ///< distance from a target [m]
  std::optional<double> base = {};  ///< its x on the way along a path [m]
  Eigen::VectorXd off = {};         ///< of every disc from the path [m]
  Eigen::VectorXd errors = {};      ///< of every disc from where it was measured [m]
};

// Its reference is among those solved before.
Solution SolveRow(const Robot& robot, const std::vector<Case>& cases, const Case& row,
                  Method method, const std::vector<Solution>& solved) {
  if (row.reference < 0) return twin_pivot::Solve(robot, row.load, method);
  const auto at = static_cast<std::size_t>(row.reference);
  if (solved[at].outcome.ok()) {
    return twin_pivot::SolveFrom(robot, cases[at].load, solved[at], row.load, method);
  }
  Solution none;
  none.outcome.why = "its reference '" + cases[at].label + "' failed";
  return none;
}

std::vector<Solution> SolveCases(const Robot& robot, const std::vector<Case>& cases,
                                 Method method) {
  std::vector<Solution> solved(cases.size());
  statics::ForRows(
      cases.size(), [&](std::size_t i) { return cases[i].reference; },
      [&](std::size_t i) { solved[i] = SolveRow(robot, cases, cases[i], method, solved); });
  return solved;
}

// With --equilibria all of a case instead of its own answer, which is one of them.
std::vector<Solved> RowsOf(const SolveRequest& request, const Robot& robot,
                           const std::vector<Case>& cases, Method method) {
  const std::vector<Solution> solved = SolveCases(robot, cases, method);
  std::vector<Solved> rows;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Case row = cases[i];
    const Eigen::VectorXd& pull = solved[i].pull;
    if (pull.size() > 0) row.load.tension.assign(pull.begin(), pull.end());
    row.load.reference = solved[i].reference;
    row.load.slide = solved[i].reference_slide;
    if (request.equilibria) {
      int count = 0;
      for (Solution& s : twin_pivot::Equilibria(robot, row.load, method, solved[i])) {
        rows.push_back({row, std::move(s), ++count});
      }
    }
    if (!request.equilibria || !solved[i].outcome.ok()) rows.push_back({row, solved[i]});
  }
  return rows;
}

// The error of the path halfway to a target.
void AddHalfway(const Robot& robot, Method method, const Solved& from, const Solved& to,
                statics::PathError& error) {
  twin_pivot::Load half = to.row.load;
  for (std::size_t j = 0; j < half.tension.size(); ++j) {
    half.tension[j] = 0.5 * (from.row.load.tension[j] + to.row.load.tension[j]);
  }
  half.length = 0.5 * (from.row.load.length + to.row.load.length);
  const Solution s = twin_pivot::SolveFrom(robot, from.row.load, from.solution, half, method);
  if (s.outcome.ok()) error.Halfway(to.row.label, s.tip, from.solution.tip, to.solution.tip);
}

// The case whose target it is, with its tensions or lengths; its reference is among those solved
// before.
Solved ReachTarget(const Robot& robot, Method method, const statics::Target& target,
                   const std::vector<Solved>& solved, const Case& row) {
  std::optional<twin_pivot::Before> before;
  if (row.reference >= 0) {
    const Solved& earlier = solved[static_cast<std::size_t>(row.reference)];
    before.emplace(twin_pivot::Before{earlier.row.load, earlier.solution});
  }
  Solved s{row, {}};
  if (before && !before->solution.outcome.ok()) {
    s.solution.outcome.why = "its reference failed";
    return s;
  }
  const auto* const from = before ? &*before : nullptr;
  const bool by_length = row.load.length.size() > 0;
  const auto reached = statics::LimitedSearch(twin_pivot::kMostOfReach, [&] {
    return (by_length ? twin_pivot::ReachByLengths : twin_pivot::Reach)(robot, row.load, method,
                                                                        target, from);
  });
  s.miss = reached.miss;
  if (!reached.outcome.ok()) {
    s.solution.outcome = reached.outcome;
    return s;
  }
  twin_pivot::Load& load = s.row.load;
  if (by_length) {
    load.length = reached.drives;
  } else {
    load.tension.assign(reached.drives.begin(), reached.drives.end());
  }
  s.solution = twin_pivot::SolveGoingOn(robot, load, method, from);
  if (s.solution.outcome.ok()) {
    load.tension.assign(s.solution.pull.begin(), s.solution.pull.end());
  }
  return s;
}

std::vector<Solved> ReachTargets(const SolveRequest& request, const Robot& robot,
                                 const std::vector<Case>& cases, Method method) {
  std::vector<std::string> names;
  for (const Case& row : cases) names.push_back(row.label);
  const auto read = statics::ReadTargets(CsvTable::Read(request.reach), robot.Joints());
  const auto targets = statics::TargetsOf(read, names, request.reach.string());
  statics::PathError error;
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    solved.push_back(ReachTarget(robot, method, targets[i], solved, cases[i]));
    if (!solved[i].solution.outcome.ok()) {
      error.NotReached();
      continue;
    }
    error.AtTarget(cases[i].label, *solved[i].miss);
    if (cases[i].reference < 0) continue;
    const auto from = static_cast<std::size_t>(cases[i].reference);
    AddHalfway(robot, method, solved[from], solved[i], error);
  }
  request.say(error.Sentence());
  return solved;
}

// The points of --follow, with the loads of the one row of --input.
std::vector<Solved> FollowPath(const SolveRequest& request, const Robot& robot,
                               const std::vector<Case>& cases, Method method) {
  if (cases.size() != 1) {
    throw Error::Input(request.input.string(), "one row, of the first point's tensions",
                       std::to_string(cases.size()));
  }
  const twin_pivot::PathLine path(CsvTable::Read(request.follow));
  std::vector<Solved> rows;
  double sum = 0, worst = 0;
  int reached = 0;
  for (auto& at : twin_pivot::Follow(robot, cases.front().load, method, path)) {
    Case row{std::to_string(rows.size() + 1), std::move(at.load)};
    std::string text = fmt::format("point {}: base at {:.4g} m, ", row.label, at.base);
    if (at.off.size() > 0) {
      Eigen::Index disc = 0;
      const double most = at.off.maxCoeff(&disc);
      text += fmt::format("{:.3g} m off the path on average, {:.3g} m at most, disc {}",
                          at.off.mean(), most, disc + 1);
      if (!at.settled) text += "; a nearer place may exist";
      sum += at.off.mean(), worst = std::max(worst, most), ++reached;
    } else {
      text += at.solution.outcome.why;
    }
    request.say(text);
    rows.push_back({std::move(row), std::move(at.solution), 0, at.miss, at.base, at.off});
  }
  request.say(fmt::format("{} of {} points, {:.3g} m off the path on average, {:.3g} m at most",
                          reached, rows.size(), sum / std::max(reached, 1), worst));
  return rows;
}

Eigen::Matrix3Xd DiscCentres(const Robot& robot, const Solution& solution) {
  const auto frames = twin_pivot::DiscFrames(robot, solution.beta);
  Eigen::Matrix3Xd centres(3, robot.Joints());
  for (int m = 0; m < robot.Joints(); ++m) {
    centres.col(m) = frames[static_cast<std::size_t>(m) + 1].translation();
  }
  return centres;
}

// Distances of the discs from where they were measured.
void AddErrors(const SolveRequest& request, const Robot& robot, std::vector<Solved>& rows) {
  if (request.measured.empty()) return;
  const auto measured =
      statics::ReadMeasuredPoints(CsvTable::Read(request.measured), robot.Joints());
  std::vector<std::string> names;
  for (const Solved& solved : rows) names.push_back(solved.row.label);
  statics::RequireShared(names, measured, request.measured.string());
  statics::ErrorTable errors(robot.Length(), robot.Joints());
  for (Solved& solved : rows) {
    const auto* const m = statics::Find(measured, solved.row.label);
    if (m == nullptr || !solved.solution.outcome.ok()) continue;
    const Eigen::Matrix3Xd off = m->disks - DiscCentres(robot, solved.solution);
    solved.errors = off.colwise().norm().transpose();
    errors.Add(m->test, solved.errors);
  }
  statics::ReportErrors(request, errors, "twin_pivot: " + request.robot.filename().string());
}

bool HasLimits(const Robot& robot) { return robot.strain_limit > 0 || robot.theta_max > 0; }

// One sentence for each limit that some row is beyond: how far at most, and how often.
void WarnOfLimits(const SolveRequest& request, const Robot& robot,
                  const std::vector<Solved>& rows) {
  struct Worst {
    double value = 0;
    std::string label;
    int count = 0;
    void See(double now, const std::string& at) {
      ++count;
      if (now > value) value = now, label = at;
    }
  } strain, theta;
  for (const Solved& solved : rows) {
    if (!solved.solution.outcome.ok()) continue;
    const twin_pivot::Extent extent(robot, solved.row.load, solved.solution);
    if (extent.BeyondStrain(robot)) strain.See(extent.strain, solved.row.label);
    if (extent.BeyondTheta(robot)) theta.See(extent.theta, solved.row.label);
  }
  const auto warn = [&](const Worst& worst, const std::string& what, double limit) {
    if (worst.count == 0) return;
    request.warn(fmt::format("{}: {} {:.3g} at '{}' is beyond {:.3g}, in {} of {} rows",
                             request.robot.string(), what, worst.value, worst.label, limit,
                             worst.count, rows.size()));
  };
  warn(strain, "strain_limit: a strain of", robot.strain_limit);
  warn(theta, "friction.theta_max: a, b, c are not measured where cables turn by [rad]",
       robot.theta_max);
}

// How many rows are no roots of the equations with the whole way from the reference.
void SayInParts(const SolveRequest& request, const std::vector<Solved>& rows) {
  const auto in_parts = [](const Solved& s) { return s.solution.parts > 1; };
  const auto first = std::find_if(rows.begin(), rows.end(), in_parts);
  if (first == rows.end()) return;
  int most = 1;
  for (const Solved& s : rows) most = std::max(most, s.solution.parts);
  request.say(fmt::format(
      "{} of {} rows, '{}' the first: contacts turned back while the load rose, so friction counts "
      "along up to {} parts of the way (column parts); they are no roots of the paper's rule",
      std::count_if(first, rows.end(), in_parts), rows.size(), first->row.label, most));
}

void WriteRow(const Robot& robot, const Solved& solved, statics::Results& results) {
  const Solution& solution = solved.solution;
  const twin_pivot::Load& load = solved.row.load;
  results.Row();
  results.Set("case", solved.row.label);
  results.Set("condition", std::string(twin_pivot::kConditions[static_cast<int>(load.condition)]));
  const bool missed = solved.miss && solution.outcome.status == numerics::Status::kOutOfDomain;
  results.Set(solution.outcome,
              missed ? "out_of_reach" : statics::StatusOf(solution.outcome, solution.stability));
  results.Set(solution.outcome, solution.stability);
  if (!solution.outcome.ok()) return;
  for (int i = 0; i < 3; ++i) results.Set(std::string(1, "xyz"[i]), solution.tip[i]);
  for (int m = 0; m < robot.Joints(); ++m) {
    results.Set("beta_" + std::to_string(m + 1), solution.beta[m]);
  }
  for (int j = 0; j < robot.Cables(); ++j) {
    results.Set("F_end_" + std::to_string(j + 1), solution.tension(robot.Anchor(j) - 1, j));
  }
  for (Eigen::Index m = 0; m < solved.errors.size(); ++m) {
    results.Set("error_" + std::to_string(m + 1), solved.errors[m]);
  }
  auto details = Describe(robot, load, solution);
  details.miss = solved.miss;
  Set(details, solved.equilibrium, results);
  if (solved.miss) SetEach("L", load.length, results);
  if (solved.base) {
    Eigen::Index disc = 0;
    results.Set("base_x", *solved.base);
    results.Set("off_mean", solved.off.mean());
    results.Set("off_max", solved.off.maxCoeff(&disc));
    results.Set("off_disc", static_cast<int>(disc) + 1);
  }
  results.Set("parts", solution.parts);
  if (HasLimits(robot)) {
    results.Set("beyond", twin_pivot::Extent(robot, load, solution).Beyond(robot));
  }
}

std::vector<std::string> Columns(const SolveRequest& request, const Robot& robot, bool by_length) {
  std::vector<std::string> columns = {"case",   "condition", "status", "iterations", "residual",
                                      "micros", "x",         "y",      "z"};
  const auto append = [&](const std::vector<std::string>& names) {
    columns.insert(columns.end(), names.begin(), names.end());
  };
  append(statics::StabilityColumns());
  append(statics::Numbered("beta_", robot.Joints()));
  append(statics::Numbered("F_end_", robot.Cables()));
  const bool reaches = !request.reach.empty() || !request.follow.empty();
  append(statics::DetailColumns{robot.Cables(), by_length, reaches, request.equilibria}.Names());
  if (!request.measured.empty()) append(statics::Numbered("error_", robot.Joints()));
  if (by_length && reaches) append(statics::Numbered("L", robot.Cables()));
  if (!request.follow.empty()) append({"base_x", "off_mean", "off_max", "off_disc"});
  append({"parts"});
  if (HasLimits(robot)) append({"beyond"});
  return columns;
}

void WriteResults(const SolveRequest& request, const Robot& robot,
                  const std::vector<Solved>& rows) {
  const bool by_length = !rows.empty() && rows.front().row.load.length.size() > 0;
  statics::Results results(Columns(request, robot, by_length));
  for (const Solved& solved : rows) WriteRow(robot, solved, results);
  statics::Write(results, request);
}

void WriteShapes(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& rows) {
  statics::ShapeTable table(robot.Cables());
  for (const Solved& solved : rows) {
    if (!solved.solution.outcome.ok()) continue;
    for (const auto& place : twin_pivot::Places(robot, solved.solution)) {
      table.Add(solved.row.label, place);
    }
  }
  table.Write(request.shape);
}

void WriteCompliance(const SolveRequest& request, const Robot& robot, Method method,
                     const std::vector<Solved>& rows) {
  const bool by_length = !rows.empty() && rows.front().row.load.length.size() > 0;
  statics::ComplianceTable table(robot.Cables(), by_length);
  for (const Solved& solved : rows) {
    if (!solved.solution.outcome.ok()) continue;
    const auto response = twin_pivot::Respond(robot, solved.row.load, method, solved.solution);
    if (response) table.Add(solved.row.label, *response);
  }
  table.Write(request.compliance);
}

void Draw(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& rows) {
  statics::Figure figure = twin_pivot::EmptyFigure(robot);
  figure.title = "twin_pivot: " + request.robot.filename().string();
  for (const Solved& solved : rows) {
    if (!solved.solution.outcome.ok()) continue;
    figure.shapes.push_back(twin_pivot::ShapeOf(robot, solved.row.load, solved.solution));
    figure.shapes.back().label = solved.row.label;
  }
  statics::WriteFigure(request.plot, figure);
}

}  // namespace

int SolveTwinPivot(const SolveRequest& request) {
  RefuseOptions(request);
  const Robot robot = Robot::Read(request.robot);
  twin_pivot::WarnOfImplausibleRobot(request, robot);
  if (request.calibrate) return Calibrate(request);
  const Method method = twin_pivot::ParseMethod(request.method);
  statics::RequireExtension(request.out, {".csv", ".json"}, "--out");
  if (!request.plot.empty()) statics::RequireFigureEnding(request.plot);
  statics::CheckErrorOptions(request);
  statics::RequireTable(request.shape, "--shape");
  statics::RequireTable(request.compliance, "--compliance");
  const std::vector<Case> cases = twin_pivot::ReadCases(statics::CasesOf(request), robot);
  const bool by_tension = cases.front().load.length.size() == 0;
  for (const auto& [option, given] : {std::pair("--equilibria", request.equilibria),
                                      std::pair("--follow", !request.follow.empty())}) {
    if (!given || by_tension) continue;
    throw Error::Input(request.input.string() + ":1", std::string("tensions with ") + option,
                       "'L1'");
  }
  twin_pivot::WarnOfImplausibleCases(request, robot, cases);
  const auto solve = !request.reach.empty()    ? ReachTargets
                     : !request.follow.empty() ? FollowPath
                                               : RowsOf;
  std::vector<Solved> rows = solve(request, robot, cases, method);
  AddErrors(request, robot, rows);
  if (HasLimits(robot)) WarnOfLimits(request, robot, rows);
  SayInParts(request, rows);
  WriteResults(request, robot, rows);
  if (!request.shape.empty()) WriteShapes(request, robot, rows);
  if (!request.compliance.empty()) WriteCompliance(request, robot, method, rows);
  if (!request.plot.empty()) Draw(request, robot, rows);
  for (const Solved& solved : rows) {
    if (!solved.solution.outcome.ok()) return 1;
  }
  return 0;
}

}  // namespace continuum
