#include "models/twin_pivot/twin_pivot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "error.h"
#include "models/twin_pivot/balance.h"
#include "models/twin_pivot/geometry.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"
#include "sim/numerics/continuation.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::VectorXd;

// A contact this wide [m] is no obstacle to Newton: cables move by about as much.
constexpr double kWidest = 1e-3;

numerics::Options Tolerances() {
  numerics::Options options;
  options.tolerance = 1e-13;
  options.accept = 1e-10;
  options.max_step = 1;
  return options;
}

// Runs one stage from x; keeps the count of iterations, and x only when it succeeded.
template <class Stage>
bool Take(numerics::Outcome& total, VectorXd& x, const Stage& stage) {
  VectorXd trial = x;
  numerics::Outcome outcome = stage(trial);
  outcome.iterations += total.iterations;
  total = outcome;
  if (total.ok()) x = trial;
  return total.ok();
}

// The root of problem_at(1): by Newton from x where that works, otherwise along the roots from that
// of problem_at(0), which is `known`.
template <class ProblemAt>
bool Reach(numerics::Outcome& total, VectorXd& x, const ProblemAt& problem_at, VectorXd known) {
  const auto newton = [&](VectorXd& y) {
    return numerics::Newton(problem_at(1.0), y, Tolerances());
  };
  if (Take(total, x, newton)) return true;
  x = std::move(known);
  return Take(total, x,
              [&](VectorXd& y) { return numerics::Continue(problem_at, y, Tolerances()); });
}

// Three stages: everything but friction; friction with contacts that turn widely; sharp contacts.
numerics::Outcome FindRoot(const Task& task, VectorXd& x) {
  numerics::Outcome total;
  const double eps = task.robot.eps;
  const double widest = std::max(kWidest, eps);
  const auto loaded = [&](double t) { return Balance{task, t, 0, widest}; };
  if (!Reach(total, x, loaded, VectorXd::Zero(task.joints)) || !task.HasFriction()) return total;
  const auto with_friction = [&](double t) { return Balance{task, 1, t, widest}; };
  if (!Reach(total, x, with_friction, x) || widest == eps) return total;
  const auto sharpened = [&](double t) {
    return Balance{task, 1, 1, std::pow(widest, 1 - t) * std::pow(eps, t)};
  };
  Reach(total, x, sharpened, x);
  return total;
}

void RequirePositiveFriction(const Task& task, const VectorXd& beta) {
  for (const double b : beta) {
    const double theta = 0.5 * std::abs(b);
    const double mu = task.friction.At(theta);
    if (mu >= 0) continue;
    throw Error::Input(task.robot.file + ": friction",
                       "a coefficient >= 0 at every angle of a solution",
                       Decimal(mu) + " at " + Decimal(theta) + " rad");
  }
}

}  // namespace

Solution Solve(const Robot& robot, const Load& load, Method method,
               const std::optional<VectorXd>& start) {
  const Task task(robot, load, method);
  Solution solution;
  solution.beta = start ? *start : VectorXd::Zero(task.joints);
  solution.outcome = numerics::Timed([&] { return FindRoot(task, solution.beta); });
  RequirePositiveFriction(task, solution.beta);
  if (!solution.outcome.ok()) {
    const auto f = Residual(robot, load, method, solution.beta);
    solution.outcome.residual = f ? f->norm() : std::numeric_limits<double>::infinity();
    return solution;
  }
  solution.tip = CentreLine(robot, solution.beta).back();
  solution.length = CableLengths(robot, solution.beta);
  std::vector<double> force;
  CableForces(task, JointsAt(robot, solution.beta), 1, robot.eps, force);
  solution.tension = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      force.data(), task.joints, task.cables);
  return solution;
}

std::optional<VectorXd> Residual(const Robot& robot, const Load& load, Method method,
                                 const VectorXd& beta) {
  const Task task(robot, load, method);
  VectorXd f(task.joints);
  if (!Balance{task, 1, 1, robot.eps}(beta.data(), f.data())) return std::nullopt;
  return f;
}

std::optional<Eigen::MatrixXd> ResidualSlope(const Robot& robot, const Load& load, Method method,
                                             const VectorXd& beta) {
  const Task task(robot, load, method);
  VectorXd f(task.joints);
  Eigen::MatrixXd slope(task.joints, task.joints);
  if (!numerics::Linearize(Balance{task, 1, 1, robot.eps}, beta, f, slope)) return std::nullopt;
  return slope;
}

}  // namespace continuum::twin_pivot
