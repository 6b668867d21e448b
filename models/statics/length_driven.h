#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "models/statics/rising_load.h"
#include "sim/numerics/last_tangent.h"

namespace continuum::statics {

/// Stretch of cables of stiffness EA [N], whose lengths without tension are given; none when EA is
/// 0. A part that is l long under T > 0 is l/(1 + T/EA) long without, so that it stretches by
/// l T/(EA + T).
class CableStretch {
 public:
  CableStretch(double EA, const Eigen::VectorXd& given) : EA_(EA), given_(given) {}

  /// Its slope by T where T is the same along the cable, L/(EA + T) [m/N].
  Eigen::VectorXd Compliance(const Eigen::VectorXd& tension) const {
    return OrNone(
        [&] { return (given_.array() / (EA_ + tension.array().max(0))).matrix().eval(); });
  }
  /// sum l T/(EA + T) [m] over the parts of the cables, parts x cables.
  template <class Tension, class Length>
  Eigen::VectorXd Of(const Tension& tension, const Length& length) const {
    return OrNone([&] {
      const Eigen::ArrayXXd T = tension.array();
      const Eigen::ArrayXXd parts = length.array() * T / (EA_ + T.max(0));
      return Eigen::VectorXd(parts.colwise().sum().transpose().matrix());
    });
  }

 private:
  template <class Value>
  Eigen::VectorXd OrNone(const Value& value) const {
    if (EA_ == 0) return Eigen::VectorXd::Zero(given_.size());
    return value();
  }

  double EA_;
  const Eigen::VectorXd& given_;
};

/// Cables that winches have wound to given lengths: their tensions are unknown, and at least 0.
///
///   f(x, T) = 0,   0 <= T_k,  0 <= L_k + stretch_k - l_k(x),  one of the two is 0            (1)
///
/// L: lengths of the cables without tension, from the base to where they end; l: of their paths.
/// (1) is written as min(a, b) = 0 of a = T/unit and b the rest over `reach`. Lengths and dead
/// loads grow together; a path that folds ends, as no fall is computed.
///
/// `Plant`, of x at a share of the dead loads and tensions T:
///   void SetLoad(double), SetTension(const VectorXd& T)
///   bool Residual(x, f), Linearize(x, f, k)            f over a stiffness
///   VectorXd Lengths(x) [m], MatrixXd LengthSlopes(x)  cables x unknowns
///   VectorXd Stretch(x) [m], Compliance(T) [m/N]       of the cables under T
///   int Unstable(x, VectorXd held)                     held [N/m]: of cables that are taut
///   double unit() [N], reach() [m]                     T and l that bend the robot by about 1
/// and, where contacts are sharp, SetWidth(double) [m]: they turn within this, or 0: as they are;
/// where they remember, SlidAt(x), SomeRest(x), GoOnFrom(x): as those of a Remembering system.
template <class Plant>
class LengthDriven {
  static constexpr bool kRemembers = requires(Plant & plant, const Eigen::VectorXd& x) {
    plant.GoOnFrom(x);
  };

 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// Both lengths [m] of every cable: where the path begins and where it ends.
  LengthDriven(Plant& plant, Vector from, Vector to)
      : plant_(plant), from_(std::move(from)), to_(std::move(to)) {}

  /// For numerics::Newton; z = (x, T/unit).
  bool operator()(const double* z, double* f) const {
    const Eigen::Index n = z_size_ - to_.size(), m = to_.size();
    const Vector x = Vector::Map(z, n), tension = Vector::Map(z + n, m);
    plant_.SetTension(plant_.unit() * tension);
    Vector balance(n);
    if (!plant_.Residual(x, balance)) return false;
    Vector::Map(f, n) = balance;
    const Vector gap = Gap(x);
    for (Eigen::Index k = 0; k < m; ++k) f[n + k] = std::min(tension[k], gap[k]);
    return true;
  }

  bool Jacobian(const Vector& z, Vector& f, Matrix& jacobian) const {
    constexpr double kStep = 1e-6;
    const Eigen::Index m = to_.size(), n = z.size() - m;
    const Vector x = z.head(n), tension = z.tail(m);
    plant_.SetTension(plant_.unit() * tension);
    Vector balance(n), moved(n);
    Matrix k(n, n);
    if (!plant_.Linearize(x, balance, k)) return false;
    const Vector gap = Gap(x);
    jacobian.setZero();
    jacobian.topLeftCorner(n, n) = k;
    const Matrix slopes = plant_.LengthSlopes(x) / -plant_.reach();
    const Vector compliance = plant_.Compliance(plant_.unit() * tension);
    for (Eigen::Index i = 0; i < m; ++i) {
      f[n + i] = std::min(tension[i], gap[i]);
      if (tension[i] < gap[i]) {
        jacobian(n + i, n + i) = 1;
        continue;
      }
      jacobian.row(n + i).head(n) = slopes.row(i);
      jacobian(n + i, n + i) = compliance[i] * plant_.unit() / plant_.reach();
    }
    for (Eigen::Index i = 0; i < m; ++i) {
      plant_.SetTension(plant_.unit() * (tension + kStep * Vector::Unit(m, i)));
      if (!plant_.Residual(x, moved)) return false;
      jacobian.col(n + i).head(n) = (moved - balance) / kStep;
    }
    f.head(n) = balance;
    return true;
  }

  /// For FollowRisingLoad.
  numerics::Outcome Correct(double load, Vector& z) {
    SetLoad(load);
    z_size_ = z.size();
    numerics::Options options;
    options.tolerance = load < 1 ? 1e-9 : 1e-12;
    options.accept = 5e-10;
    options.damped = false;
    options.max_iterations = 15;
    Vector trial = z;
    numerics::Outcome outcome = tangent_.Newton(*this, trial, options);
    if (!outcome.ok()) {  // where cables or contacts change between two states
      const int spent = outcome.iterations;
      options.damped = true;
      options.max_step = 0.3;
      options.max_iterations = 40;
      trial = z;
      outcome = tangent_.Newton(*this, trial, options);
      outcome.iterations += spent;
    }
    if constexpr (requires { plant_.SetWidth(0.0); }) {
      if (!outcome.ok()) outcome = Sharpened(z, trial, options, outcome.iterations);
    }
    if (outcome.ok()) z = trial;
    return outcome;
  }
  int Unstable(double load, const Vector& z) {
    SetLoad(load);
    const Eigen::Index m = to_.size();
    const Vector tension = plant_.unit() * z.tail(m);
    plant_.SetTension(tension);
    Vector held = Vector::Zero(m);
    const Vector compliance = plant_.Compliance(tension);
    const double stiffest = kHeld * plant_.unit() / plant_.reach();
    for (Eigen::Index k = 0; k < m; ++k) {
      if (z[z.size() - m + k] < kTaut) continue;
      held[k] = std::min(stiffest, 1 / std::max(compliance[k], 1e-300));
    }
    return plant_.Unstable(z.head(z.size() - m), held);
  }
  statics::Fall Fall(double /*from*/, double /*load*/, Vector& /*z*/) { return {}; }

  /// For TurningContacts.
  void SetLoad(double load) {
    plant_.SetLoad(load);
    now_ = (1 - load) * from_ + load * to_;
  }
  Vector Slid(const Vector& z) requires kRemembers { return plant_.SlidAt(ShapeIn(z)); }
  bool SomeRest(const Vector& z) requires kRemembers { return plant_.SomeRest(ShapeIn(z)); }
  void GoOnFrom(const Vector& z) requires kRemembers { plant_.GoOnFrom(ShapeIn(z)); }
  Vector Rate(double load, const Vector& z, bool exact) requires kRemembers {
    return tangent_.Rate(*this, z, SlopeByLoad(*this, load, z), exact);
  }

 private:
  Vector ShapeIn(const Vector& z) const { return z.head(z.size() - to_.size()); }

  static constexpr double kTaut = 1e-7, kHeld = 1e6;

  // By contacts that turn widely, then sharply.
  numerics::Outcome Sharpened(const Vector& z, Vector& trial, const numerics::Options& options,
                              int spent) {
    numerics::Outcome outcome;
    trial = z;
    for (const double width : {1e-3, 1e-4, 1e-5, 0.0}) {
      plant_.SetWidth(width);
      outcome = tangent_.Newton(*this, trial, options);
      spent += outcome.iterations;
      if (!outcome.ok()) break;
    }
    plant_.SetWidth(0);
    outcome.iterations = spent;
    return outcome;
  }

  Vector Gap(const Vector& x) const {
    return (now_ + plant_.Stretch(x) - plant_.Lengths(x)) / plant_.reach();
  }

  Plant& plant_;
  Vector from_, to_, now_;
  Eigen::Index z_size_ = 0;
  numerics::LastTangent<Eigen::PartialPivLU<Matrix>, Eigen::Dynamic> tangent_{0};
};

/// Follows lengths and dead loads from z = (x, T/unit), where they are in balance. T is in newtons
/// afterwards, exactly 0 of slack cables.
template <class Plant>
numerics::Outcome FollowLengths(Plant& plant, const Eigen::VectorXd& from,
                                const Eigen::VectorXd& to, Eigen::VectorXd& x,
                                Eigen::VectorXd& tension, Stability& stability) {
  constexpr double kSlack = 1e-7;  // of unit
  LengthDriven<Plant> system(plant, from, to);
  Eigen::VectorXd z(x.size() + tension.size());
  z << x, tension / plant.unit();
  RisingOptions options;
  options.trust = 3 / std::sqrt(static_cast<double>(z.size()));
  numerics::Outcome outcome = FollowRisingLoad(system, z, stability.branch, options);
  if (!outcome.ok() && plant.Compliance(tension).isZero(0)) {
    outcome.why += "; cables that do not stretch may be too short together";
  }
  x = z.head(x.size());
  tension = plant.unit() * z.tail(tension.size());
  for (double& t : tension) {
    if (t < kSlack * plant.unit()) t = 0;
  }
  return outcome;
}

}  // namespace continuum::statics
