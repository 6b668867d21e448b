#include "models/stiff_flop/forward.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "models/stiff_flop/rod.h"
#include "sim/numerics/continuation.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {
namespace {

using Dual = Rod::Dual;
using Eigen::Vector3d;

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

/// Solves one case: keeps M(0) and what is known about the branch.
class Balance {
 public:
  Balance(const Module& module, const Method& method, const Case& row)
      : module_(module), method_(method), row_(row) {}

  const Vector3d& moment() const { return moment_; }

  const Tip& tip() const { return tip_; }
  const Axis<double>& base() const { return base_; }

  /// Newton from the moments of the straight module, else along the rising load; then finer steps
  /// until they change nothing.
  numerics::Outcome Solve() {
    moment_ = Straight();
    numerics::Outcome outcome = Shoot(kFirstSteps);
    if (!trusted_) outcome = Recover(outcome);
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

  /// Why there is no answer, from the last point of the path that had one.
  Status Reason() const {
    if (last_.domain < kSpent && last_.domain < last_.stiffness) return Status::kOutOfDomain;
    if (last_.stiffness < kSpent || last_determinant_ < kSpent) return Status::kNoEquilibrium;
    return Status::kNotConverged;
  }

 private:
  // Near the end of a path of smallest step 1e-5 the stiffness has fallen to about sqrt(1e-5).
  static constexpr double kSpent = 0.05;

  // Moment of all loads about the base of the unbent module, per unit.
  Vector3d Straight() const {
    const Vector3d y = Vector3d::UnitY();
    const Vector3d weight =
        (0.5 * module_.m * module_.l + module_.m_fs * (module_.l + 0.5 * module_.l_fs)) *
        row_.load.gravity;
    const Vector3d tip = (module_.l + module_.l_fs) * row_.load.force;
    return y.cross(weight + tip) / Rod(module_, method_, row_, 1, 1).unit();
  }

  static numerics::Outcome After(const numerics::Outcome& before, numerics::Outcome outcome) {
    outcome.iterations += before.iterations;
    return outcome;
  }

  numerics::Outcome Shoot(int steps) {
    steps_ = steps;
    Rod rod(module_, method_, row_, 1, steps);
    const numerics::Outcome outcome = numerics::Newton(Shooting{&rod}, moment_);
    stable_ = outcome.ok() && tip_.Find(rod, moment_) && rod.reserve().stiffness > 0 &&
              rod.reserve().plain;
    trusted_ = stable_ && tip_.determinant > 0;
    base_ = rod.base();
    return outcome;
  }

  // Along the rising load. Past a bifurcation there may be no path to follow: a direct answer with
  // stable sections stays one.
  numerics::Outcome Recover(const numerics::Outcome& direct) {
    const Vector3d moment = moment_;
    const numerics::Outcome along = After(direct, Climb());
    if (along.ok()) return After(along, Shoot(kFirstSteps));
    if (!stable_) return along;
    moment_ = moment;
    return direct;
  }

  numerics::Outcome Climb() {
    steps_ = 2 * kFirstSteps;
    moment_.setZero();
    std::optional<Rod> rod;
    Axis<double> base{1, 0, 0};
    const auto at = [&](double fraction) {
      rod.emplace(module_, method_, row_, fraction, steps_);
      rod->StartFrom(base);
      return Shooting{&*rod};
    };
    const auto on_branch = [&](const Vector3d& moment) {
      Tip tip;
      if (!tip.Find(*rod, moment) || rod->reserve().stiffness <= 0) return false;
      if (IsJump(module_, base, rod->base())) return false;
      base = rod->base();
      last_ = rod->reserve();
      last_determinant_ = tip.determinant;
      return true;
    };
    return numerics::Continue(at, moment_, {}, {}, on_branch);
  }

  // How far tip (per l) and moment (per unit) move when every step is halved.
  double ChangeOfHalvedSteps() {
    Rod finer(module_, method_, row_, 1, 2 * steps_);
    finer.StartFrom(base_);
    Rod::State<double> fine;
    if (!finer.Integrate(moment_, fine)) return std::numeric_limits<double>::infinity();
    double moved = 0;
    for (int i = 0; i < 3; ++i) moved = std::hypot(moved, fine[i] - tip_.state[i].a);
    return std::max(moved / module_.l, finer.Mismatch(fine).norm());
  }

  const Module& module_;
  const Method& method_;
  const Case& row_;
  Vector3d moment_ = Vector3d::Zero();
  int steps_ = kFirstSteps;
  Tip tip_;
  Axis<double> base_ = {1, 0, 0};
  bool stable_ = false;   // every section
  bool trusted_ = false;  // and the rod as a whole
  Reserve last_ = {};
  double last_determinant_ = 1;
};

void Read(const Balance& balance, Solution& solution) {
  const Axis<double>& base = balance.base();
  solution.answer << std::hypot(base.k_1, base.k_2), std::atan2(base.k_2, base.k_1), base.lambda;
  const Eigen::Matrix<Dual, 3, 1> tangent = Rod::Tangent<Dual>(balance.tip().state);
  for (int i = 0; i < 3; ++i) {
    solution.tip[i] = balance.tip().state[i].a;
    solution.tangent[i] = tangent[i].a;
  }
}

}  // namespace

Solution SolveForward(const Module& module, const Method& method, const Case& row, bool sensitivity,
                      std::vector<Vector3d>* line) {
  Solution solution;
  Balance balance(module, method, row);
  solution.outcome = numerics::Timed([&] {
    const numerics::Outcome outcome = balance.Solve();
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
    solution.section = Describe(module, method, balance.base());
    return outcome;
  });
  if (line == nullptr) return solution;
  line->clear();
  if (!solution.outcome.ok()) return solution;
  Rod rod(module, method, row, 1, kPiecesOfLine);
  rod.StartFrom(balance.base());
  *line = rod.Line(balance.moment());
  return solution;
}

std::vector<Vector3d> ForwardLine(const Module& module, const Method& method, const Case& row) {
  std::vector<Vector3d> line;
  SolveForward(module, method, row, false, &line);
  return line;
}

Vector3d BaseMoment(const Module& module, const Method& method, const Case& row) {
  Balance balance(module, method, row);
  if (!balance.Solve().ok()) return Vector3d::Constant(std::nan(""));
  return balance.moment() * Rod(module, method, row, 1, 1).unit();
}

}  // namespace continuum::stiff_flop
