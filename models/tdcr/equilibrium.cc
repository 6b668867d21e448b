#include "models/tdcr/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "models/tdcr/disk_system.h"
#include "models/tdcr/rod_system.h"
#include "sim/numerics/newton.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using numerics::Outcome;

// Sum of the dead forces F at s, times the integral of the rod's compliance c(s) = int_0^s 1/K from
// 0 to s, and of the moments times c: by Cauchy, turns phi of the sections have
// phi(s)^2 <= c(s) int K phi'^2, so that below 1 no load buckles the rod.
double ShareOfBuckling(const Robot& robot, const Loads& loads) {
  double compliance = 0, integral = 0, sum = 0;
  Eigen::Index disk = 0;
  for (const Section& section : robot.sections) {
    const double softness = 1 / section.Softest();
    double from = 0;
    for (const double place : section.disks) {
      const double h = place - from;
      integral += h * (compliance + h * softness / 2);
      compliance += h * softness;
      double force = (section.disk_mass + h * section.mass_per_length) * loads.gravity.norm();
      if (loads.disk_force.size() > 0) force += loads.disk_force.col(disk).norm();
      sum += force * integral;
      if (loads.disk_moment.size() > 0) sum += loads.disk_moment.col(disk).norm() * compliance;
      from = place;
      ++disk;
    }
  }
  return sum + loads.tip_force.norm() * integral;
}

// Of the dead loads [EI/L^2]: all at the tip of a rod as soft as the softest section, or, where
// that is less, each where it is.
double Size(const Robot& robot, const Loads& loads) {
  const double size = loads.DeadForce(robot) * robot.length * robot.length / robot.Softest();
  if (!robot.has_sections()) return size;
  return std::min(size, kOneEquilibrium * ShareOfBuckling(robot, loads));
}

statics::RisingOptions Steps(const Robot& robot, const Loads& loads) {
  statics::RisingOptions options;
  const double size = Size(robot, loads);
  options.largest_step = std::clamp(2 / size, 0.02, 1.0);
  options.first_step = std::min(0.25, options.largest_step);
  return options;
}

// Contacts hardly move, whatever the rod does: what may move is the curvature alone.
statics::RisingOptions StepsOfContacts(const Robot& robot, const Loads& loads,
                                       const Eigen::VectorXd& x) {
  statics::RisingOptions options = Steps(robot, loads);
  options.trust *= std::sqrt(3 / static_cast<double>(x.size()));
  return options;
}

// Where contacts that remember have slid: the root without friction, with the tendons' lengths.
Eigen::VectorXd WithoutFriction(const Robot& robot, const Loads& loads, const RodBalance& balance) {
  Loads smooth = loads;
  smooth.mu = 0;
  const RodBalance rod(robot, smooth, false, balance.steps());
  Eigen::Vector3d u = rod.Natural();
  if (!numerics::Newton(rod, u, Limits()).ok()) return {};
  return balance.Slid(u);
}

// At full load from x, or from where the path began: falls to rest.
template <class System, class Vector>
bool FindAny(System& system, const Vector& begin, Vector& x) {
  Vector trial = x;
  for (const bool again : {false, true}) {
    if (again) trial = begin;
    if (system.Fall(1, 1, trial).ok) {
      x = trial;
      return true;
    }
  }
  return false;
}

template <class System, class Balance, class Vector>
Found Find(System& system, const Balance& balance, Vector& x, bool direct,
           const statics::RisingOptions& steps, const Eigen::VectorXd* start) {
  Found found;
  const Vector begin = x;
  const auto newton = [&] {
    const int spent = found.outcome.iterations;
    found.outcome = system.Solve(x);
    found.outcome.iterations += spent;
    if (!found.outcome.ok()) return false;
    found.stability.unstable_directions = system.Unstable(1, x);
    return found.stability.stable() &&
           statics::Turning<System, Vector>(system).Share(0, begin, 1, x) == 1;
  };
  if (start != nullptr && start->size() == x.size()) {
    x = *start;
    if (newton()) return found;
    x = begin;
  }
  if (direct) {
    if (newton()) return found;
    x = begin;
  }
  const int spent = found.outcome.iterations;
  found.outcome = statics::FollowRisingLoad(system, x, found.stability.branch, steps);
  found.outcome.iterations += spent;
  found.stability.unstable_directions = 0;
  if (found.outcome.ok()) return found;
  const Vector last = x;
  if (FindAny(system, begin, x)) {
    found.stability.branch = statics::Branch::kOther;
    found.outcome.status = numerics::Status::kOk;
    found.outcome.why.clear();
  } else {
    x = last;
  }
  Vector f = x;
  found.outcome.residual = numerics::NormAt(balance, x, f);
  return found;
}

// Whether the dead forces beyond each section pull along the rod there, or across it: F.t >= 0. A
// turn phi of the sections costs int K phi'^2 + F.t |phi x t|^2, so that no rising load folds the
// path of such shapes.
bool IsPulledAlong(const RodBalance& balance, const Eigen::Vector3d& x) {
  const UnitRod& rod = balance.rod();
  const auto& shape = balance.Integrate(x);
  if (rod.friction || rod.has_moments() || !shape.valid) return false;
  const int steps = balance.steps();
  for (int i = 0; i < rod.arcs() * steps; ++i) {
    const RodArc& arc = rod.Arc(i / steps);
    const double from = arc.start() + (i % steps) * arc.length() / steps;
    const double to = from + arc.length() / steps;
    const auto tangent = [&](int at) {
      return Vector3d(shape.frames[static_cast<std::size_t>(at)] * Vector3d::UnitZ());
    };
    if (rod.Force(i / steps, from).dot(tangent(i)) < 0) return false;
    if (rod.Force(i / steps, to).dot(tangent(i + 1)) < 0) return false;
  }
  return true;
}

// Newton from x, where such a shape leads to another one.
std::optional<Found> FindHanging(RodSystem<Vector3d>& system, const RodBalance& balance,
                                 Vector3d& x) {
  if (!IsPulledAlong(balance, x)) return std::nullopt;
  Vector3d hanging = x;
  Found found;
  found.outcome = system.Solve(hanging);
  if (!found.outcome.ok() || !IsPulledAlong(balance, hanging)) return std::nullopt;
  found.stability.unstable_directions = system.Unstable(1, hanging);
  if (!found.stability.stable()) return std::nullopt;
  x = hanging;
  return found;
}

}  // namespace

bool OneEquilibrium(const Robot& robot, const Loads& loads) {
  return Size(robot, loads) < kOneEquilibrium;
}

template <int C>
Found FindEquilibrium(const Robot& robot, const Loads& loads, DiskBalance<C>& balance,
                      typename DiskBalance<C>::Vector& x, const Eigen::VectorXd* start) {
  DiskSystem<C> system(balance);
  Eigen::VectorXd frictionless;
  if (start == nullptr && loads.AsItSlides() && OneEquilibrium(robot, loads)) {
    // Contacts are so sharp that Newton has to begin where all of them have slid.
    Loads without = loads;
    without.mu = 0;
    typename DiskBalance<C>::Vector y = x;
    if (numerics::Newton(DiskBalance<C>(robot, without), y, Limits()).ok()) {
      frictionless = y;
      start = &frictionless;
    }
  }
  return Find(system, system, x, OneEquilibrium(robot, loads), Steps(robot, loads), start);
}

template <int C>
Found ContinueEquilibrium(const Robot& robot, const Loads& loads, DiskBalance<C>& balance,
                          typename DiskBalance<C>::Vector& x) {
  DiskSystem<C> system(balance);
  return Find(system, system, x, false, Steps(robot, loads), nullptr);
}

template Found ContinueEquilibrium(const Robot&, const Loads&, DiskBalance<6>&,
                                   DiskBalance<6>::Vector&);
template Found ContinueEquilibrium(const Robot&, const Loads&, DiskBalance<Eigen::Dynamic>&,
                                   DiskBalance<Eigen::Dynamic>::Vector&);

template Found FindEquilibrium(const Robot&, const Loads&, DiskBalance<6>&, DiskBalance<6>::Vector&,
                               const Eigen::VectorXd*);
template Found FindEquilibrium(const Robot&, const Loads&, DiskBalance<Eigen::Dynamic>&,
                               DiskBalance<Eigen::Dynamic>::Vector&, const Eigen::VectorXd*);

Found FindEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance,
                      Eigen::Vector3d& x, const Eigen::VectorXd* start) {
  RodSystem<Eigen::Vector3d> system(robot, balance);
  const bool one = OneEquilibrium(robot, loads);
  if (!one && start == nullptr) {
    if (const auto found = FindHanging(system, balance, x)) return *found;
  }
  return Find(system, balance, x, one, Steps(robot, loads), start);
}

Found FindEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance,
                      Eigen::VectorXd& x, const Eigen::VectorXd* start) {
  RodSystem<Eigen::VectorXd> system(robot, balance);
  Eigen::VectorXd slid;
  if (start == nullptr && OneEquilibrium(robot, loads)) {
    slid = WithoutFriction(robot, loads, balance);
    start = slid.size() > 0 ? &slid : nullptr;
  }
  return Find(system, balance, x, OneEquilibrium(robot, loads), StepsOfContacts(robot, loads, x),
              start);
}

Found ContinueEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance,
                          Eigen::VectorXd& x) {
  RodSystem<Eigen::VectorXd> system(robot, balance);
  return Find(system, balance, x, false, StepsOfContacts(robot, loads, x), nullptr);
}

template <int C>
int UnstableDirections(DiskBalance<C>& balance, const typename DiskBalance<C>::Vector& x) {
  return DiskSystem<C>(balance).Unstable(1, x);
}

template int UnstableDirections(DiskBalance<6>&, const DiskBalance<6>::Vector&);
template int UnstableDirections(DiskBalance<Eigen::Dynamic>&,
                                const DiskBalance<Eigen::Dynamic>::Vector&);

template <class Vector>
int UnstableDirections(const Robot& robot, RodBalance& balance, const Vector& x,
                       const Eigen::VectorXd& winches) {
  return RodSystem<Vector>(robot, balance, winches).Unstable(balance.load(), x);
}

template int UnstableDirections(const Robot&, RodBalance&, const Eigen::Vector3d&,
                                const Eigen::VectorXd&);
template int UnstableDirections(const Robot&, RodBalance&, const Eigen::VectorXd&,
                                const Eigen::VectorXd&);

template <class Balance, class Vector>
numerics::Outcome Polish(const Balance& balance, Vector& x) {
  return numerics::Newton(balance, x, Limits());
}

template Outcome Polish(const RodBalance&, Eigen::Vector3d&);
template Outcome Polish(const RodBalance&, Eigen::VectorXd&);
template Outcome Polish(const DiskBalance<6>&, DiskBalance<6>::Vector&);
template Outcome Polish(const DiskBalance<Eigen::Dynamic>&, DiskBalance<Eigen::Dynamic>::Vector&);

}  // namespace continuum::tdcr
