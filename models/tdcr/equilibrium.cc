#include "models/tdcr/equilibrium.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "models/statics/dense_system.h"
#include "models/tdcr/rod_law.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using numerics::Outcome;

numerics::Options Limits() {
  numerics::Options options;
  options.tolerance = 1e-12;
  options.accept = 5e-10;
  options.max_step = 6;  // radians over the whole rod
  return options;
}

// A Newton method that gives up where it would leave the neighbourhood.
numerics::Options Corrector(double load) {
  constexpr double kOnTheWay = 1e-8;  // of EI/L
  numerics::Options options = Limits();
  if (load < 1) options.tolerance = kOnTheWay;
  options.damped = false;
  options.max_iterations = 12;
  return options;
}

/// The segment of arcs between disks. It is a problem for numerics::Newton that keeps the last
/// tangent: one a step away from the root is enough where nothing is near buckling.
template <int C>
class DiskSystem {
 public:
  using Vector = typename DiskBalance<C>::Vector;
  using Matrix = typename DiskBalance<C>::Matrix;

  explicit DiskSystem(DiskBalance<C>& balance) : balance_(balance) {
    last_x_.setConstant(balance.unknowns(), std::numeric_limits<double>::infinity());
    last_.setZero(balance.unknowns(), balance.unknowns());
  }

  bool operator()(const double* x, double* f) const { return balance_(x, f); }
  bool Jacobian(const Vector& x, Vector& f, Matrix& jacobian) const {
    if (!balance_.Jacobian(x, f, jacobian)) return false;
    last_x_ = x;
    last_ = jacobian;
    return true;
  }

  Outcome Correct(double load, Vector& x) {
    balance_.SetLoad(load);
    return numerics::Newton(*this, x, Corrector(load));
  }

  int Unstable(double load, const Vector& x) {
    balance_.SetLoad(load);
    if (ClearlyStable(x)) return 0;
    Vector f(x.size());
    if (!Jacobian(x, f, last_)) return static_cast<int>(x.size());
    // Its moments act at the starts of arcs, so that the tangent is not quite symmetric.
    if (Eigen::LLT<Matrix>(Symmetric()).info() == Eigen::Success) return 0;
    return statics::NegativeRealParts(balance_.RelativeToUnloaded(last_));
  }

  statics::Fall Fall(double /*from*/, double load, Vector& x) {
    balance_.SetLoad(load);
    statics::DenseSystem<DiskSystem> system(*this);
    Eigen::VectorXd shape = x;
    statics::Fall fall = statics::FallToRest(system, shape);
    x = shape;
    fall.ok = fall.ok && Correct(load, x).ok() && Unstable(load, x) == 0;
    return fall;
  }

  /// For statics::DenseSystem.
  bool Relative(const Eigen::VectorXd& at, Eigen::VectorXd& r, Eigen::MatrixXd* k) const {
    const Vector x = at;
    Vector f(x.size());
    if (k == nullptr) {
      if (!balance_(x.data(), f.data())) return false;
    } else {
      Matrix jacobian(x.size(), x.size());
      if (!balance_.Jacobian(x, f, jacobian)) return false;
      *k = balance_.RelativeToUnloaded(jacobian);
    }
    r = balance_.RelativeToUnloaded(f);
    return r.allFinite();
  }

 private:
  Matrix Symmetric() const {
    const Matrix k = balance_.Stiffness(balance_.RelativeToUnloaded(last_));
    return 0.5 * (k + k.transpose());
  }

  // By the tangent of Newton's last step but one, with a twentieth of the unloaded stiffness to
  // spare; tangents are no further apart when x is within 0.02.
  bool ClearlyStable(const Vector& x) const {
    constexpr double kClose = 0.02, kSpare = 0.05;
    if (last_x_.size() != x.size() || !((last_x_ - x).norm() <= kClose)) return false;
    Matrix spare = Matrix::Identity(x.size(), x.size());
    spare = Symmetric() - kSpare * balance_.Stiffness(spare);
    return Eigen::LLT<Matrix>(spare).info() == Eigen::Success;
  }

  DiskBalance<C>& balance_;
  mutable Vector last_x_;
  mutable Matrix last_;
};

/// The Cosserat rod: roots by shooting, stability and falls by a chain of rigid pieces. Contacts
/// that remember stay as they are while the rod falls.
template <class Vector>
class RodSystem {
 public:
  using Chain = statics::RodChain<RodLaw>;

  /// winches: as RodLaw::SetWinches.
  RodSystem(const Robot& robot, RodBalance& balance, Eigen::VectorXd winches = {})
      : robot_(robot), balance_(balance), winches_(std::move(winches)) {}

  Outcome Correct(double load, Vector& x) {
    balance_.SetLoad(load);
    if (!balance_.remembers()) return numerics::Newton(balance_, x, Corrector(load));
    Vector trial = x;
    Outcome outcome = numerics::Newton(balance_, trial, Corrector(load));
    if (!outcome.ok()) {
      const int spent = outcome.iterations;
      trial = x;
      outcome = Sharpened(load, trial);
      outcome.iterations += spent;
    }
    if (outcome.ok()) x = trial;
    return outcome;
  }

  // The count of a coarse chain is that of the rod unless an eigenvalue is near zero: then of finer
  // ones. Friction adds at most mu sum T r/2 of the unloaded stiffness.
  int Unstable(double load, const Vector& x) {
    constexpr double kSpare = 0.05, kNear = 0.01;  // chains of 9 and 36 pieces: 0.01, 0.001
    balance_.SetLoad(load);
    const bool friction = balance_.rod().friction;
    int unstable = Count(x, kPieces, kSpare + (friction ? FrictionShare() : 0));
    if (unstable == 0) return 0;
    const bool held = friction || winches_.size() > 0;
    unstable = Count(x, kFallingPieces, held ? 0 : kNear);
    return unstable == kNearZero ? Count(x, kManyPieces, 0) : unstable;
  }

  statics::Fall Fall(double from, double load, Vector& x) {
    balance_.SetLoad(from);
    Chain::Shape shape = Frames(x, kFallingPieces);
    if (shape.empty()) return {};
    const Eigen::MatrixXd share = Shares(x);
    balance_.SetLoad(load);
    RodLaw law(balance_.rod(), Pieces(shape), share);
    Chain chain(law, law.lengths());
    statics::Fall fall = statics::FallToRest(chain, shape);
    if (!fall.ok) return fall;
    const Eigen::Matrix3Xd zeta = chain.zeta();
    const Vector3d u = BaseCurvature(law, zeta);
    x = balance_.remembers() ? balance_.Unknowns(u, law.Beyond(zeta)) : Eigen::VectorXd(u);
    fall.ok = numerics::Newton(balance_, x, Limits()).ok() && Near(x, shape.back()) &&
              Unstable(load, x) == 0;
    return fall;
  }

 private:
  // By contacts that turn widely, then more and more sharply.
  Outcome Sharpened(double load, Vector& x) {
    Outcome outcome;
    int spent = 0;
    for (const double width : {1e-4, 1e-5, kGivesWay}) {
      balance_.SetWidth(width);
      numerics::Options options = Corrector(load);
      options.damped = true;
      options.max_iterations = 20;
      outcome = numerics::Newton(balance_, x, options);
      spent += outcome.iterations;
      if (!outcome.ok()) break;
    }
    balance_.SetWidth(kGivesWay);
    outcome.iterations = spent;
    return outcome;
  }

  static constexpr int kPieces = 9, kFallingPieces = 36, kManyPieces = 144;
  static constexpr int kNearZero = 98, kUnknown = 99;

  // Unstable directions, or kNearZero when they are not the same within `spare` of the stiffness.
  int Count(const Vector& x, int pieces, double spare) {
    const Chain::Shape shape = Frames(x, pieces);
    if (shape.empty()) return kUnknown;
    RodLaw law(balance_.rod(), Pieces(shape), Shares(x));
    law.SetWinches(winches_);
    Chain chain(law, law.lengths());
    if (spare > 0 && chain.DefiniteAt(shape, -spare)) return 0;
    if (!chain.Linearize(shape)) return kUnknown;
    if (spare == 0) return UnstableDirections(chain, law, shape);
    return chain.Definite(spare) ? kNearZero : chain.UnstableDirections();
  }

  double FrictionShare() const {
    const UnitRod& rod = balance_.rod();
    double share = 0;
    for (const double pull : rod.pull) share += 0.75 * rod.mu * pull;
    return share * robot_.tendon_radius / robot_.length;
  }

  static int Pieces(const Chain::Shape& shape) { return static_cast<int>(shape.size()) - 1; }

  // Of contacts that remember.
  Eigen::MatrixXd Shares(const Vector& x) const {
    return balance_.remembers() ? balance_.ContactsAt(x).share : Eigen::MatrixXd();
  }

  // Frames of the root x, at least so many pieces. Contacts that remember are tied to the steps, so
  // that frames are left out instead.
  Chain::Shape Frames(const Vector& x, int pieces) {
    const int steps = balance_.steps();
    const int arcs = balance_.rod().arcs();
    const int wanted = std::max(1, (pieces + arcs - 1) / arcs);
    if (!balance_.remembers()) balance_.SetSteps(wanted);
    const RodBalance::Shape& shape = balance_.Integrate(x);
    balance_.SetSteps(steps);
    if (!shape.valid) return {};
    if (!balance_.remembers()) return shape.frames;
    int stride = std::max(1, steps / wanted);
    while (steps % stride != 0) --stride;
    Chain::Shape some;
    for (std::size_t i = 0; i < shape.frames.size(); i += static_cast<std::size_t>(stride)) {
      some.push_back(shape.frames[i]);
    }
    return some;
  }

  // From the middles of the first two pieces, where they are of one arc.
  static Vector3d BaseCurvature(const RodLaw& law, const Eigen::Matrix3Xd& zeta) {
    if (!law.OneArc(0, 1)) return zeta.col(0);
    return 1.5 * zeta.col(0) - 0.5 * zeta.col(1);
  }

  bool Near(const Vector& x, const Eigen::Quaterniond& end) const {
    const auto& shape = balance_.Integrate(x);
    return shape.valid && shape.frames.back().angularDistance(end) < 0.2;
  }

  const Robot& robot_;
  RodBalance& balance_;
  Eigen::VectorXd winches_;
};

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
    found.outcome = numerics::Newton(balance, x, Limits());
    found.outcome.iterations += spent;
    if (!found.outcome.ok()) return false;
    found.stability.unstable_directions = system.Unstable(1, x);
    return found.stability.stable();
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
  return Find(system, balance, x, OneEquilibrium(robot, loads), Steps(robot, loads), start);
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
