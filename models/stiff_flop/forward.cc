#include "models/stiff_flop/forward.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "models/statics/relax.h"
#include "models/stiff_flop/rod.h"
#include "models/stiff_flop/rod_law.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"
#include "sim/numerics/work_limit.h"

namespace continuum::stiff_flop {
namespace {

using Dual = Rod::Dual;
using Eigen::Vector3d;

// Linear systems of a row, sections included. Of the 63 pushes of the README the hardest takes
// 96724.
constexpr long kMostSystems = 1000000;
constexpr int kFirstSteps = 2;
constexpr int kMostSteps = 256;
constexpr double kDiscretisation = 1e-10;  // of l and of the moment unit
constexpr double kHalvingsGain = 100;      // 2^8 for an eighth-order rule; some held back
constexpr int kPiecesOfLine = 32;

/// M(l) as a function of M(0), for the solver.
struct Shooting {
  Rod* rod;

  bool operator()(const double* x, double* f) const {
    Rod::State<double> tip;
    Vector3d::Map(f).setZero();
    if (!rod->Integrate(Vector3d::Map(x), tip)) return false;
    Vector3d::Map(f) = rod->Mismatch(tip);
    return true;
  }

  bool Jacobian(const Vector3d& x, Vector3d& f, Eigen::Matrix3d& jacobian) const {
    Rod::State<Dual> tip;
    if (!rod->Integrate(x, tip)) return false;
    const Eigen::Matrix<Dual, 3, 1> mismatch = rod->Mismatch(tip);
    for (int i = 0; i < 3; ++i) {
      f[i] = mismatch[i].a;
      jacobian.row(i) = mismatch[i].v.head<3>().transpose();
    }
    return true;
  }
};

/// Shape at the answer, with its derivatives.
struct Tip {
  Rod::State<Dual> state;
  Eigen::Matrix<double, 3, 5> mismatch;  // by M(0), gamma, E
  double determinant = 0;

  bool Find(Rod& rod, const Vector3d& moment) {
    if (!rod.Integrate(moment, state)) return false;
    const Eigen::Matrix<Dual, 3, 1> value = rod.Mismatch(state);
    for (int i = 0; i < 3; ++i) mismatch.row(i) = value[i].v.transpose();
    determinant = mismatch.leftCols<3>().determinant();
    return true;
  }

  /// d rho(l) by gamma and E, at fixed base and with the mismatch kept at zero.
  Eigen::Matrix<double, 3, 2> Sensitivity() const {
    const Eigen::Matrix<double, 3, 2> moment =
        -mismatch.leftCols<3>().fullPivLu().solve(mismatch.rightCols<2>());
    Eigen::Matrix<double, 3, 2> rho;
    for (int i = 0; i < 3; ++i) {
      rho.row(i) = state[i].v.tail<2>().transpose() + state[i].v.head<3>().transpose() * moment;
    }
    return rho;
  }
};

numerics::Options Corrector() {
  numerics::Options options;
  options.damped = false;
  options.max_iterations = 12;
  return options;
}

/// The modules as a system for statics::FollowRisingLoad, in M(0) per unit: roots by shooting,
/// stability and falls by a chain of rigid pieces.
class RisingSystem {
 public:
  using Chain = statics::RodChain<RodLaw>;
  static constexpr int kSteps = 2 * kFirstSteps;  // of every module

  RisingSystem(const ModuleSeries& series, const Method& method, const Case& row)
      : series_(series), method_(method), row_(row), bases_(Unstrained(series)) {}

  numerics::Outcome Correct(double load, Vector3d& moment) {
    Rod rod = RodAt(load, kSteps);
    return numerics::Newton(Shooting{&rod}, moment, Corrector());
  }

  // Also where sections carry no more, or jump.
  int Unstable(double load, const Vector3d& moment) {
    Rod rod = RodAt(load, kSteps);
    Tip tip;
    if (!tip.Find(rod, moment) || rod.reserve().stiffness <= 0) return kUnknown;
    if (IsJump(series_, bases_, rod.bases())) return kUnknown;
    const int unstable = Count(load, moment, rod.bases());
    if (unstable != 0) return unstable;
    bases_ = rod.bases();
    last_ = rod.reserve();
    last_determinant_ = tip.determinant;
    return 0;
  }

  statics::Fall Fall(double from, double load, Vector3d& moment) {
    Chain::Shape shape = Frames(from, moment, kFallingPieces);
    if (shape.empty()) return {};
    RodLaw law(series_, method_, row_, load, kFallingPieces);
    Chain chain(law, law.Lengths());
    statics::FallOptions options;
    options.tolerance = 1e-9;
    statics::Fall fall = statics::FallToRest(chain, shape, options);
    if (!fall.ok) return fall;
    const Axes before = bases_;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      bases_[i] = law.axis(static_cast<int>(i) * kFallingPieces);
    }
    moment = BaseMoment(law, chain, shape);
    Rod rod = RodAt(load, kSteps);
    fall.ok = numerics::Newton(Shooting{&rod}, moment).ok() && Near(load, moment, shape.back()) &&
              Unstable(load, moment) == 0;
    if (!fall.ok) bases_ = before;
    return fall;
  }

  const Axes& bases() const { return bases_; }
  const Reserve& last() const { return last_; }
  double last_determinant() const { return last_determinant_; }

  /// Unstable directions of a root whose lower sections are known.
  int Count(double load, const Vector3d& moment, const Axes& bases) {
    const Axes before = bases_;
    bases_ = bases;
    const int coarse = Count(load, moment, kPieces);
    const int fine = coarse == kNearZero ? Count(load, moment, kManyPieces) : coarse;
    bases_ = before;
    return fine;
  }

 private:
  // Of every module.
  static constexpr int kPieces = 8, kFallingPieces = 16, kManyPieces = 64;
  static constexpr int kNearZero = 98, kUnknown = 99;

  Rod RodAt(double load, int steps) const {
    Rod rod(series_, method_, row_, load, steps);
    rod.StartFrom(bases_);
    return rod;
  }

  Chain::Shape Frames(double load, const Vector3d& moment, int pieces) const {
    Chain::Shape shape;
    for (const auto& states : RodAt(load, pieces).States(moment)) {
      if (!shape.empty()) shape.pop_back();  // a mount does not turn
      for (const Rod::State<double>& y : states) {
        shape.push_back(Eigen::Quaterniond(y[3], y[4], y[5], y[6]).normalized());
      }
    }
    return shape;
  }

  // kNearZero: not the same within a twentieth of the stiffness; never for the finest chain.
  int Count(double load, const Vector3d& moment, int pieces) const {
    constexpr double kSpare = 0.05;  // a chain of 8 pieces is off by 0.01
    const Chain::Shape shape = Frames(load, moment, pieces);
    if (shape.empty()) return kUnknown;
    RodLaw law(series_, method_, row_, load, pieces);
    Chain chain(law, law.Lengths());
    if (!chain.Linearize(shape)) return kUnknown;
    if (pieces == kManyPieces) return chain.UnstableDirections();
    if (chain.Definite(-kSpare)) return 0;
    return chain.Definite(kSpare) ? kNearZero : chain.UnstableDirections();
  }

  // m(0) = m_1 - h/2 (F x t)_1, per unit.
  Vector3d BaseMoment(RodLaw& law, const Chain& chain, const Chain::Shape& shape) const {
    const Eigen::Matrix3d R = shape[0].slerp(0.5, shape[1]).toRotationMatrix();
    const double h = law.Lengths().front();
    const Vector3d F = law.Force(h / 2);
    statics::RodSection section;
    law.At(0, chain.zeta().col(0), R.transpose() * F, section);
    return R * section.moment - 0.5 * h * F.cross(Vector3d(R * section.stretch));
  }

  bool Near(double load, const Vector3d& moment, const Eigen::Quaterniond& end) const {
    const Chain::Shape shape = Frames(load, moment, kSteps);
    return !shape.empty() && shape.back().angularDistance(end) < 0.2;
  }

  const ModuleSeries& series_;
  const Method& method_;
  const Case& row_;
  Axes bases_;
  Reserve last_ = {};
  double last_determinant_ = 1;
};

/// Solves one case: keeps M(0) and what is known about the branch.
class Balance {
 public:
  Balance(const ModuleSeries& series, const Method& method, const Case& row)
      : series_(series),
        method_(method),
        row_(row),
        rising_(series, method, row),
        bases_(Unstrained(series)) {}

  const Vector3d& moment() const { return moment_; }
  const Tip& tip() const { return tip_; }
  const Axes& bases() const { return bases_; }
  const statics::Stability& stability() const { return stability_; }

  /// Newton from the moments of the straight module, else along the rising load; then finer steps
  /// until they change nothing.
  numerics::Outcome Solve() {
    moment_ = Straight();
    numerics::Outcome outcome = Shoot(kFirstSteps);
    if (!trusted_ || !FarFromBuckling()) outcome = Rise(outcome);
    outcome = Refined(outcome);
    if (outcome.ok() && !counted_) Judge(outcome);
    return outcome;
  }

  /// The root next to a moment, whatever its stability.
  numerics::Outcome Near(const Vector3d& moment) {
    moment_ = moment;
    const numerics::Outcome outcome = Refined(Shoot(kFirstSteps));
    if (!outcome.ok()) return outcome;
    stability_.unstable_directions = rising_.Count(1, moment_, bases_);
    return outcome;
  }

  /// Why there is no answer, from the last point of the path that had one.
  Status Reason() const {
    const Reserve& last = rising_.last();
    if (last.domain < kSpent && last.domain < last.stiffness) return Status::kOutOfDomain;
    if (saddle_ || last.stiffness < kSpent || rising_.last_determinant() < kSpent) {
      return Status::kNoEquilibrium;
    }
    return Status::kNotConverged;
  }

 private:
  // Finer steps until they change nothing.
  numerics::Outcome Refined(numerics::Outcome outcome) {
    while (outcome.ok()) {
      const double change = ChangeOfHalvedSteps();
      if (change <= kDiscretisation) break;
      if (steps_ == kMostSteps) {
        outcome.status = numerics::Status::kNoConvergence;
        outcome.why = "the discretisation does not converge";
        break;
      }
      outcome = After(outcome, Shoot(2 * steps_));
      if (change <= kHalvingsGain * kDiscretisation) break;
    }
    return outcome;
  }

  // Near the end of a path of smallest step 1e-5 the stiffness has fallen to about sqrt(1e-5).
  static constexpr double kSpent = 0.05;

  // Moment of all loads about the base of the unbent modules, per unit.
  Vector3d Straight() const {
    double way = 0;
    Vector3d lever = Vector3d::Zero();
    for (const Module& m : series_.modules) {
      lever += (m.m * (way + 0.5 * m.l) + m.m_fs * (way + m.l + 0.5 * m.l_fs)) * row_.load.gravity;
      way += m.l + m.l_fs;
    }
    lever += way * row_.load.force;
    return Vector3d::UnitY().cross(lever) / series_.unit();
  }

  static numerics::Outcome After(const numerics::Outcome& before, numerics::Outcome outcome) {
    outcome.iterations += before.iterations;
    return outcome;
  }

  // Dead loads, all at the end of the last mount and along it, below 2 EI/L^2 of the softest
  // section: the clamped column buckles at pi^2/4.
  bool FarFromBuckling() const {
    constexpr double kMost = 2;
    const double force = row_.load.force.norm() + series_.mass() * row_.load.gravity.norm();
    double length = series_.mounts();
    double stiffness = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < series_.size(); ++i) {
      length += bases_[i].lambda * series_[i].l;
      stiffness = std::min(stiffness, series_[i].E * series_[i].SecondMoment());
    }
    return force * length * length < kMost * stiffness * std::min(1.0, reserve_.stiffness);
  }

  numerics::Outcome Shoot(int steps) {
    steps_ = steps;
    Rod rod(series_, method_, row_, 1, steps);
    if (counted_) rod.StartFrom(bases_);
    const numerics::Outcome outcome = numerics::Newton(Shooting{&rod}, moment_);
    stable_ = outcome.ok() && tip_.Find(rod, moment_) && rod.reserve().stiffness > 0 &&
              rod.reserve().plain;
    trusted_ = stable_ && tip_.determinant > 0;
    bases_ = rod.bases();
    reserve_ = rod.reserve();
    return outcome;
  }

  // Along the rising load, through folds. Where that ends, a direct answer that stands stays one.
  numerics::Outcome Rise(const numerics::Outcome& direct) {
    const Vector3d moment = moment_;
    const bool carried = stable_;
    Vector3d x = Vector3d::Zero();
    statics::RisingOptions options;
    options.first_step = 0.25;
    const numerics::Outcome along =
        After(direct, statics::FollowRisingLoad(rising_, x, stability_.branch, options));
    if (along.ok()) {
      counted_ = true;
      moment_ = x;
      bases_ = rising_.bases();
      return After(along, Shoot(RisingSystem::kSteps));  // whose root x is
    }
    if (!carried) return along;
    along_ = along.why;
    moment_ = moment;
    stability_.branch = statics::Branch::kOther;
    return After(along, Shoot(kFirstSteps));
  }

  // A root that was not reached along the rising load is looked at here.
  void Judge(numerics::Outcome& outcome) {
    counted_ = true;
    if (trusted_ && FarFromBuckling()) return;
    stability_.unstable_directions = rising_.Count(1, moment_, bases_);
    saddle_ = !stability_.stable();
    if (!saddle_) return;
    outcome.status = numerics::Status::kNoConvergence;
    outcome.why = "only an unstable equilibrium was found: " + along_;
    if (Reason() == Status::kOutOfDomain) outcome.why += "; there the section folds";
  }

  // How far tip (per l) and moment (per unit) move when every step is halved.
  double ChangeOfHalvedSteps() {
    Rod finer(series_, method_, row_, 1, 2 * steps_);
    finer.StartFrom(bases_);
    Rod::State<double> fine;
    if (!finer.Integrate(moment_, fine)) return std::numeric_limits<double>::infinity();
    double moved = 0;
    for (int i = 0; i < 3; ++i) moved = std::hypot(moved, fine[i] - tip_.state[i].a);
    return std::max(moved / series_.length(), finer.Mismatch(fine).norm());
  }

  const ModuleSeries& series_;
  const Method& method_;
  const Case& row_;
  RisingSystem rising_;
  Vector3d moment_ = Vector3d::Zero();
  int steps_ = kFirstSteps;
  Tip tip_;
  Axes bases_;
  Reserve reserve_ = {};
  bool stable_ = false;   // every section
  bool trusted_ = false;  // and no single direction of the whole
  bool counted_ = false;  // unstable directions are known
  bool saddle_ = false;
  std::string along_;  // where the rising load ended
  statics::Stability stability_;
};

void Read(const Balance& balance, Solution& solution) {
  const Axis<double>& base = balance.bases().front();
  solution.moment = balance.moment();
  solution.bases = balance.bases();
  solution.answer =
      Vector3d(std::hypot(base.k_1, base.k_2), std::atan2(base.k_2, base.k_1), base.lambda);
  const Eigen::Matrix<Dual, 3, 1> tangent = Rod::Tangent<Dual>(balance.tip().state);
  for (int i = 0; i < 3; ++i) {
    solution.tip[i] = balance.tip().state[i].a;
    solution.tangent[i] = tangent[i].a;
  }
}

}  // namespace

Solution SolveForward(const ModuleSeries& series, const Method& method, const Case& row,
                      bool sensitivity) {
  Solution solution;
  Balance balance(series, method, row);
  solution.outcome = numerics::Limited(kMostSystems, [&] {
    const numerics::Outcome outcome = balance.Solve();
    solution.stability = balance.stability();
    if (!outcome.ok()) {
      solution.status = balance.Reason();
      return outcome;
    }
    solution.status = Status::kOk;
    Read(balance, solution);
    if (sensitivity) {
      const Eigen::Matrix<double, 3, 2> slopes = balance.tip().Sensitivity();
      if (method.chamber != ChamberLaw::kFixed) solution.by_gamma = slopes.col(0);
      solution.by_E = slopes.col(1);
    }
    solution.section = Describe(series.first(), method, balance.bases().front());
    return outcome;
  });
  return solution;
}

Solution SolveNear(const ModuleSeries& series, const Method& method, const Case& row,
                   const Vector3d& moment) {
  Solution solution;
  Balance balance(series, method, row);
  solution.outcome = numerics::Limited(kMostSystems, [&] { return balance.Near(moment); });
  if (!solution.outcome.ok()) return solution;
  solution.stability = balance.stability();
  solution.status = Status::kOk;
  Read(balance, solution);
  solution.section = Describe(series.first(), method, balance.bases().front());
  return solution;
}

std::vector<std::vector<Vector3d>> LinesOf(const ModuleSeries& series, const Method& method,
                                           const Case& row, const Solution& solution) {
  if (!solution.outcome.ok()) return {};
  Rod rod(series, method, row, 1, kPiecesOfLine);
  rod.StartFrom(solution.bases);
  return rod.Lines(solution.moment);
}

std::vector<Vector3d> ForwardLine(const ModuleSeries& series, const Method& method,
                                  const Case& row) {
  std::vector<Vector3d> whole;
  const Solution solution = SolveForward(series, method, row, false);
  for (const auto& line : LinesOf(series, method, row, solution)) {
    whole.insert(whole.end(), line.begin(), line.end());
  }
  return whole;
}

Vector3d BaseMoment(const ModuleSeries& series, const Method& method, const Case& row) {
  const Solution solution = SolveForward(series, method, row, false);
  if (!solution.outcome.ok()) return Vector3d::Constant(std::nan(""));
  return solution.moment * series.unit();
}

}  // namespace continuum::stiff_flop
