#include "models/twin_pivot/twin_pivot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "error.h"
#include "models/twin_pivot/balance.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/rising.h"
#include "models/twin_pivot/winches.h"
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

// From contacts that turn within `width` to those that turn within robot.eps.
void Sharpen(const Task& task, double width, numerics::Outcome& total, VectorXd& x) {
  const auto sharpened = [&](double t) {
    return Balance{task, 1, 1, std::pow(width, 1 - t) * std::pow(task.robot.eps, t)};
  };
  Reach(total, x, sharpened, x);
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
  Sharpen(task, widest, total, x);
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

// Whether the dead loads, all at the tip and along it, leave one equilibrium: below pi^2/4 EI/l^2
// of a column with the stiffness of the softest joint less that which bent cables take away, F L/12
// each.
bool FarFromBuckling(const Task& task) {
  constexpr double kMost = 2;  // < pi^2/4
  const Robot& robot = task.robot;
  double weight = task.payload + task.m_D.sum() + task.m_NiTi.sum() + task.m_CL.sum();
  for (int j = 0; j < task.cables; ++j) {
    weight += task.rho[j] * robot.LengthOfCable(j);
  }
  double tension = 0;
  for (const double t : task.tension) tension += t;
  const double length = robot.Length(), pitch = length / task.joints;
  double rod = 0;
  for (const Link& link : task.links) rod = std::max(rod, link.L);
  const double stiffness = 2 * pitch * (task.stiffness.minCoeff() - tension * rod / 12);
  double force = weight * task.gravity.norm() + task.force.norm() + task.moment.norm() / length;
  for (const DiscLoad& load : task.loads) {
    force += load.force.norm() + load.moment.norm() / length;
  }
  return force * length * length < kMost * stiffness;
}

// At full load from x, whatever it is.
bool FindAny(RisingSystem& system, VectorXd& x, VectorXd other) {
  for (VectorXd* const trial : {&x, &other}) {
    if (!system.Fall(1, 1, *trial).ok) continue;
    x = *trial;
    return true;
  }
  return false;
}

// Along the loads from where x is in balance; else whatever stands.
void Follow(RisingSystem& system, const VectorXd& other, Solution& solution,
            const statics::RisingOptions& options = {}) {
  const int spent = solution.outcome.iterations;
  solution.stability = {};
  solution.outcome =
      statics::FollowRisingLoad(system, solution.beta, solution.stability.branch, options);
  solution.outcome.iterations += spent;
  if (solution.outcome.ok()) return;
  if (!FindAny(system, solution.beta, other)) {
    if (system.driven() > 0) solution.outcome.why += "; where it rests friction may drive a motion";
    return;
  }
  solution.outcome.status = numerics::Status::kOk;
  solution.outcome.why.clear();
  solution.stability.branch = statics::Branch::kOther;
}

void Describe(const Task& task, Solution& solution) {
  const Robot& robot = task.robot;
  RequirePositiveFriction(task, solution.beta);
  if (!solution.outcome.ok()) {
    VectorXd f(task.joints);
    const bool inside = Balance{task, 1, 1, robot.eps}(solution.beta.data(), f.data());
    solution.outcome.residual = inside ? f.norm() : std::numeric_limits<double>::infinity();
    return;
  }
  solution.tip = CentreLine(robot, solution.beta).back();
  solution.length = CableLengths(robot, solution.beta);
  solution.slide.setZero(task.joints, task.cables);
  std::vector<double> force;
  CableForces(task, JointsAt(robot, solution.beta), 1, robot.eps, force, nullptr, &solution.slide);
  solution.tension = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      force.data(), task.joints, task.cables);
}

// From the state of `solution` and winches at `before`.
void Wind(const Load& load, const Task& from, const VectorXd& before, VectorXd tension, Task& task,
          Solution& solution) {
  solution.outcome = numerics::Timed([&] {
    return FollowWinches(from, task, before, load.length, solution.beta, tension,
                         solution.stability);
  });
  solution.pull = tension;
  task.tension.assign(tension.begin(), tension.end());
  Describe(task, solution);
}

}  // namespace

Solution Solve(const Robot& robot, const Load& load, Method method,
               const std::optional<VectorXd>& start) {
  Task task(robot, load, method);
  Solution solution;
  if (load.length.size() > 0) {
    solution.beta = VectorXd::Zero(task.joints);
    const VectorXd unwound = CableLengths(robot, solution.beta).colwise().sum();
    Wind(load, task.Unloaded(), unwound, VectorXd::Zero(task.cables), task, solution);
    return solution;
  }
  solution.outcome = numerics::Timed([&] {
    const VectorXd straight = VectorXd::Zero(task.joints);
    solution.beta = start ? *start : straight;
    if (FarFromBuckling(task)) {
      solution.outcome = FindRoot(task, solution.beta);
      if (solution.outcome.ok()) {
        const Balance balance{task, 1, 1, robot.eps};
        solution.stability.unstable_directions = UnstableDirections(balance, solution.beta);
        if (solution.stability.stable()) return solution.outcome;
      }
    }
    const VectorXd other = solution.beta;
    const Task unloaded = task.Unloaded();
    RisingSystem system(unloaded, task);
    solution.beta = straight;
    Follow(system, other, solution);
    return solution.outcome;
  });
  Describe(task, solution);
  return solution;
}

Solution SolveFrom(const Robot& robot, const Load& earlier, const Solution& before, Load load,
                   Method method) {
  load.reference = before.length;
  load.slide = before.slide;
  Task task(robot, load, method);
  const Task from(robot, earlier, method);
  Solution solution;
  if (load.length.size() > 0) {
    solution.beta = before.beta;
    Wind(load, from, earlier.length, before.pull, task, solution);
    return solution;
  }
  solution.outcome = numerics::Timed([&] {
    RisingSystem system(from, task);
    solution.beta = before.beta;
    statics::RisingOptions options;  // at once where that leads no farther than a step may
    options.first_step = options.largest_step = 1;
    options.trust = 0.1;
    Follow(system, before.beta, solution, options);
    return solution.outcome;
  });
  Describe(task, solution);
  return solution;
}

Solution SolveNear(const Robot& robot, const Load& load, Method method, const VectorXd& beta,
                   double width) {
  const Task task(robot, load, method);
  Solution solution;
  solution.outcome = numerics::Timed([&] {
    solution.beta = beta;
    Sharpen(task, std::max(width, robot.eps), solution.outcome, solution.beta);
    if (solution.outcome.ok()) {
      const Balance balance{task, 1, 1, robot.eps};
      solution.stability.unstable_directions = UnstableDirections(balance, solution.beta);
    }
    return solution.outcome;
  });
  Describe(task, solution);
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
