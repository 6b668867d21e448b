#include "models/twin_pivot/twin_pivot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

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
#include "sim/numerics/work_limit.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::VectorXd;

// A contact this wide [m] is no obstacle to Newton: cables move by about as much.
constexpr double kWidest = 1e-3;
// Linear systems of a row. Of the 120 loads near upright of the README the hardest takes 1336.
constexpr long kMostSystems = 20000;
constexpr int kParts = 50;  // of loads that grow; their friction remembers each

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

// Adds to what was spent. Leaves the stability of its answer alone.
bool Rise(const Task& from, const Task& to, Solution& solution,
          const statics::RisingOptions& options) {
  RisingSystem system(from, to);
  const int spent = solution.outcome.iterations;
  solution.outcome =
      statics::FollowRisingLoad(system, solution.beta, solution.stability.branch, options);
  solution.outcome.iterations += spent;
  return solution.outcome.ok();
}

// Of a path whose rows are near to each other: at once where a step leads no farther than it may.
statics::RisingOptions AtOnce() {
  statics::RisingOptions options;
  options.first_step = options.largest_step = 1;
  options.trust = 0.1;
  return options;
}

bool IsRoot(const Task& task, const VectorXd& beta) {
  VectorXd f(task.joints);
  const Balance balance{task, 1, 1, task.robot.eps};
  return balance(beta.data(), f.data()) && f.norm() <= Tolerances().accept;
}

// The loads grow from those of a row before. Where contacts turn back, `to` gets what they slid
// from last.
bool GoOn(const Task& from, Task& to, Solution& solution, const statics::RisingOptions& options) {
  Task now = to;
  RememberingSystem system(from, now);
  const int spent = solution.outcome.iterations;
  solution.outcome =
      statics::FollowRisingLoad(system, solution.beta, solution.stability.branch, options);
  solution.outcome.iterations += spent;
  if (!solution.outcome.ok() || IsRoot(to, solution.beta)) return solution.outcome.ok();
  to.reference = now.reference;
  to.slide = now.slide;
  solution.parts = system.parts();
  return true;
}

// The loads grow in parts, and every contact goes on from the part before: one that turns back on
// the way resists there, whatever its whole way was. Where some did, `to` gets what the last part
// began with. @returns the longest part of the way |change of beta|; none where the way ends.
std::optional<double> RiseInParts(const Task& from, Task& to, Solution& solution, int parts,
                                  const statics::RisingOptions& options) {
  Task now = to;
  std::vector<double> force;
  double longest = 0;
  for (int i = 0; i < parts; ++i) {
    const auto at = [&](int part) { return now.Between(from, static_cast<double>(part) / parts); };
    if (i > 0) {
      now.slide = SlideAt(at(i), solution.beta, force);
      now.reference = CableLengths(to.robot, solution.beta);
    }
    const VectorXd last = solution.beta;
    const double share = static_cast<double>(i) / parts;
    try {
      if (!Rise(at(i), at(i + 1), solution, options)) {
        solution.outcome.why =
            "the rising load ends at " + Decimal(share) + " of it, and no stable shape was found";
        return std::nullopt;
      }
    } catch (numerics::GaveUp& given_up) {
      given_up.where = statics::AtShare(share);
      throw;
    }
    longest = std::max(longest, (solution.beta - last).norm());
  }
  if (IsRoot(to, solution.beta)) return longest;
  to.reference = now.reference;
  to.slide = now.slide;
  solution.parts = parts;
  return longest;
}

// Few parts do where no contact turned back, or where four and eight end at one tip. Every part is
// one step to a stable shape, and the way grows evenly: below the buckling load P_c it grows as
// t/(1 - t P/P_c), at the end 1/(1 - P/P_c) times as fast as on average.
bool RiseInFewParts(const Task& from, Task& to, Solution& solution) {
  constexpr double kEven = 5.0 / 3;  // P = 0.4 P_c
  constexpr double kSame = 2e-4;     // of the length
  statics::RisingOptions one_step = AtOnce();
  one_step.most_steps = 1;
  const Solution begin = solution;
  std::optional<Eigen::Vector3d> last;
  for (const int parts : {4, 8}) {
    Task task = to;
    const int spent = solution.outcome.iterations;
    solution = begin;
    solution.outcome.iterations = spent;
    const auto longest = RiseInParts(from, task, solution, parts, one_step);
    if (!longest || *longest * parts > kEven * solution.beta.norm()) return false;
    const Eigen::Vector3d tip = CentreLine(to.robot, solution.beta).back();
    if (solution.parts == 1 || (last && (tip - *last).norm() < kSame * to.robot.Length())) {
      to.reference = task.reference;
      to.slide = task.slide;
      return true;
    }
    last = tip;
  }
  return false;
}

// At full load from one of these, whatever it is.
bool FindAny(const Task& task, Solution& solution, VectorXd other, int* driven) {
  RisingSystem system(task, task);
  for (VectorXd* const trial : {&solution.beta, &other}) {
    const bool found = system.Fall(1, 1, *trial).ok;
    *driven = system.driven();
    if (!found) continue;
    solution.beta = *trial;
    return true;
  }
  return false;
}

// What is found at full load where no path of the loads ends.
void Fallback(const Task& task, const VectorXd& other, Solution& solution) {
  int driven = 0;
  if (!FindAny(task, solution, other, &driven)) {
    if (driven > 0) solution.outcome.why += "; where it rests friction may drive a motion";
    return;
  }
  solution.outcome.status = numerics::Status::kOk;
  solution.outcome.why.clear();
  solution.stability.branch = statics::Branch::kOther;
}

using Way = std::function<bool(Solution&)>;

// Along the loads by the first of these ways that leads to a stable shape; all begin where
// solution.beta is in balance. Else whatever stands.
void Follow(const Task& to, const VectorXd& other, Solution& solution,
            const std::vector<Way>& ways) {
  solution.stability = {};
  const Solution begin = solution;
  for (const Way& rises : ways) {
    const int spent = solution.outcome.iterations;
    solution = begin;
    solution.outcome.iterations = spent;
    if (rises(solution)) return;
  }
  Fallback(to, other, solution);
}

// `to` gets what the contacts slid from.
void FollowFromRest(Task& to, const VectorXd& other, Solution& solution) {
  const Task from = to.Unloaded();
  const Way few = [&](Solution& s) { return RiseInFewParts(from, to, s); };
  const Way parts = [&](Solution& s) {
    return RiseInParts(from, to, s, kParts, AtOnce()).has_value();
  };
  const Way at_once = [&](Solution& s) { return Rise(from, to, s, {}); };
  Follow(to, other, solution,
         to.HasFriction() ? std::vector<Way>{few, parts, at_once} : std::vector<Way>{at_once});
}

void FollowOn(const Task& from, Task& to, Solution& solution) {
  const Way on = [&](Solution& s) { return GoOn(from, to, s, AtOnce()); };
  const Way parts = [&](Solution& s) {
    return RiseInParts(from, to, s, kParts, AtOnce()).has_value();
  };
  const VectorXd begin = solution.beta;
  Follow(to, begin, solution,
         to.HasFriction() ? std::vector<Way>{on, parts} : std::vector<Way>{on});
}

void Describe(const Task& task, Solution& solution) {
  const Robot& robot = task.robot;
  RequirePositiveFriction(task, solution.beta);
  solution.reference = task.reference;
  solution.reference_slide = task.slide;
  if (!solution.outcome.ok()) {
    VectorXd f(task.joints);
    const bool inside = Balance{task, 1, 1, robot.eps}(solution.beta.data(), f.data());
    solution.outcome.residual = inside ? f.norm() : std::numeric_limits<double>::infinity();
    return;
  }
  solution.tip = CentreLine(robot, solution.beta).back();
  solution.length = CableLengths(robot, solution.beta);
  std::vector<double> force;
  solution.slide = SlideAt(task, solution.beta, force);
  solution.tension = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      force.data(), task.joints, task.cables);
}

// From the state of `solution` and winches at `before`.
void Wind(const Load& load, const Task& from, const VectorXd& before, VectorXd tension, Task& task,
          Solution& solution) {
  solution.outcome = numerics::Limited(kMostSystems, [&] {
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
  solution.outcome = numerics::Limited(kMostSystems, [&] {
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
    solution.beta = straight;
    FollowFromRest(task, other, solution);
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
  solution.outcome = numerics::Limited(kMostSystems, [&] {
    solution.beta = before.beta;
    FollowOn(from, task, solution);
    return solution.outcome;
  });
  Describe(task, solution);
  return solution;
}

Solution SolveNear(const Robot& robot, const Load& load, Method method, const VectorXd& beta,
                   double width) {
  const Task task(robot, load, method);
  Solution solution;
  solution.outcome = numerics::Limited(kMostSystems, [&] {
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
