#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>

#include "effects/pcc_segment.h"
#include "models/spa/base_motion.h"

namespace continuum {

/// Parameters of the soft pneumatic actuator, named as in its table of identified parameters.
template <class T>
struct SpaParameters {
  T L0, d, r_ch;        ///< length at rest, reference distance, chamber radius [m]
  T x_m, y_m;           ///< offset of the chambers' centre [m]
  T T_PT1;              ///< lag of the chamber pressure [s]
  T A;                  ///< effective area of a chamber [m²]
  T m;                  ///< mass [kg]
  T d_theta, d_dL;      ///< damping of bending and elongation [kg/s]
  T k_theta, k_theta3;  ///< bending stiffness, linear [N/m] and cubic [N/m³]
  T k_dL1, k_dL3;       ///< elongation stiffness, linear [N/m] and cubic [N/m³]

  PccSegment<T> Segment() const { return {L0, d}; }
  PccChambers<T> Chambers() const { return {r_ch, x_m, y_m, A}; }
  PccSegmentLaw::Params<T> Law() const {
    return {L0, d, r_ch, x_m, y_m, A, d_theta, d_dL, k_theta, k_theta3, k_dL1, k_dL3};
  }

  template <class U>
  SpaParameters<U> Cast() const {
    return {U(L0), U(d),       U(r_ch), U(x_m),     U(y_m),      U(T_PT1), U(A),
            U(m),  U(d_theta), U(d_dL), U(k_theta), U(k_theta3), U(k_dL1), U(k_dL3)};
  }
};

/// Where the mass is: all of it at the centre of gravity (the paper; bending inertia m L²/36 when
/// straight), or spread evenly along the arc (m L²/20).
enum class SpaMass { kCentroid, kArc };

/// How pressure drives the segment: PccTipForces (the paper) or PccVolumeForces.
enum class SpaActuation { kTip, kVolume };

struct SpaOptions {
  SpaMass mass = SpaMass::kCentroid;
  SpaActuation actuation = SpaActuation::kTip;
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< in world axes [m/s²]
};

/// δ = (Δx, Δy, δL) [m] and its rate [m/s].
template <class T>
struct SpaState {
  Eigen::Matrix<T, 3, 1> delta = Eigen::Matrix<T, 3, 1>::Zero();
  Eigen::Matrix<T, 3, 1> rate = Eigen::Matrix<T, 3, 1>::Zero();
};

template <class T>
struct SpaEnergy {
  T kinetic, gravity, elastic;
};

/// Soft pneumatic actuator of one segment of constant curvature on a moving base.
///
///   M(q) q̈ + c(q, q̇) + g(q) + d(q̇) + k(q) = τ,   q = (base, Δx, Δy, δL)              (16)
///   k = (k_theta3 Δx³ + k_theta Δx, same in Δy, k_dL3 δL³ + k_dL1 δL)                 (12)
///   d = (d_theta Δẋ, d_theta Δẏ, d_dL δL̇)                                             (14)
///
/// The base rows are written in the twist (velocity, angular velocity) of SpaBase, i.e. they are
/// the force [N] and the torque [N m] at the base origin in base axes; SpaCardan::Jacobian turns
/// them into rows of the six base coordinates. Closed chambers add nothing there. T is double or a
/// dual. Source: PCC kinematics with a floating base, eqs. 1-30; signs and limits derived.
template <class T>
class Spa {
 public:
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  using Vector6 = Eigen::Matrix<T, 6, 1>;
  using Vector9 = Eigen::Matrix<T, 9, 1>;
  using Matrix3 = Eigen::Matrix<T, 3, 3>;
  using Matrix9 = Eigen::Matrix<T, 9, 9>;

  /// Parameters that (16) is linear in, in the order of Regressor's columns.
  static constexpr int kLinear = 7;

  explicit Spa(const SpaParameters<T>& parameters, const SpaOptions& options = {})
      : p_(parameters), options_(options), places_(Places(options.mass)) {}

  const SpaParameters<T>& parameters() const { return p_; }
  const SpaOptions& options() const { return options_; }

  /// Pose of the tip in base axes.
  PccTip<T> Tip(const Vector3& delta) const { return PccTipPose(p_.Segment(), Array(delta)); }

  /// Generalised forces [N] on δ of the chamber pressures [Pa] (21)-(26).
  Vector3 Actuation(const Vector3& delta, const Vector3& pressure) const {
    const int law = options_.actuation == SpaActuation::kTip ? 0 : 1;
    return ToEigen(PccSegmentLaw::Drive(Array(delta), Array(pressure), law, p_.Law()));
  }

  /// Hybrid dynamics (28): δ̈ [m/s²] for a given motion of the base and chamber pressures [Pa].
  Vector3 Acceleration(const SpaState<T>& state, const SpaBase<T>& base,
                       const Vector3& pressure) const {
    Matrix3 inertia = Matrix3::Zero();
    Vector3 bias = Vector3::Zero();
    for (const Mass& mass : Masses(state)) {
      const Vector3 force = mass.amount * Apparent(mass, base);
      bias += mass.jacobian.transpose() * force;
      inertia += mass.amount * mass.jacobian.transpose() * mass.jacobian;
    }
    const Vector3 net = Actuation(state.delta, pressure) - Material(state) - bias;
    return inertia.ldlt().solve(net);
  }

  /// Left side of (16): force [N], torque [N m] that the mount exerts on the actuator at the base
  /// origin, in base axes (at rest −m g), and the generalised forces [N] on δ.
  Vector9 InverseDynamics(const SpaState<T>& state, const Vector3& acceleration,
                          const SpaBase<T>& base) const {
    Vector9 left = Vector9::Zero();
    for (const Mass& mass : Masses(state)) {
      const Vector3 force = mass.amount * (Apparent(mass, base) + mass.jacobian * acceleration);
      left.template head<3>() += force;
      left.template segment<3>(3) += mass.position.cross(force);
      left.template tail<3>() += mass.jacobian.transpose() * force;
    }
    left.template tail<3>() += Material(state);
    return left;
  }

  /// The first six rows of InverseDynamics; acceleration is δ̈.
  Vector6 BaseWrench(const SpaState<T>& state, const Vector3& acceleration,
                     const SpaBase<T>& base) const {
    return InverseDynamics(state, acceleration, base).template head<6>();
  }

  /// Ψ of (30), 9 x kLinear: InverseDynamics = Ψ (m, d_theta, d_dL, k_theta, k_theta3, k_dL1,
  /// k_dL3).
  Eigen::Matrix<T, 9, kLinear> Regressor(const SpaState<T>& state, const Vector3& acceleration,
                                         const SpaBase<T>& base) const {
    Eigen::Matrix<T, 9, kLinear> psi = Eigen::Matrix<T, 9, kLinear>::Zero();
    for (const Mass& mass : Masses(state, T(1.0))) {
      const Vector3 force = mass.amount * (Apparent(mass, base) + mass.jacobian * acceleration);
      psi.col(0).template head<3>() += force;
      psi.col(0).template segment<3>(3) += mass.position.cross(force);
      psi.col(0).template tail<3>() += mass.jacobian.transpose() * force;
    }
    for (int i = 0; i < 3; ++i) {
      const T x = state.delta[i];
      psi(6 + i, i < 2 ? 1 : 2) = state.rate[i];
      psi(6 + i, i < 2 ? 3 : 5) = x;
      psi(6 + i, i < 2 ? 4 : 6) = x * x * x;
    }
    return psi;
  }

  Eigen::Matrix<T, kLinear, 1> LinearParameters() const {
    return {p_.m, p_.d_theta, p_.d_dL, p_.k_theta, p_.k_theta3, p_.k_dL1, p_.k_dL3};
  }

  /// M over (velocity, angular velocity, δ̇). The block of δ is positive definite. The whole is only
  /// semidefinite: one point mass has rank 3, and turning a thin arc about the base's z equals a
  /// change of (Δx, Δy), so that an arc has rank 8 at most.
  Matrix9 MassMatrix(const Vector3& delta) const {
    Matrix9 m = Matrix9::Zero();
    for (const Mass& mass : Masses({delta, Vector3::Zero()})) {
      Eigen::Matrix<T, 3, 9> j;
      j.template leftCols<3>().setIdentity();
      j.template middleCols<3>(3) = -Cross(mass.position);
      j.template rightCols<3>() = mass.jacobian;
      m += mass.amount * j.transpose() * j;
    }
    return m;
  }

  /// Momentum [kg m/s] and angular momentum about the base origin [kg m²/s], in base axes.
  Vector6 Momentum(const SpaState<T>& state, const SpaBase<T>& base) const {
    Vector6 h = Vector6::Zero();
    for (const Mass& mass : Masses(state)) {
      const Vector3 momentum = mass.amount * Velocity(mass, base);
      h.template head<3>() += momentum;
      h.template tail<3>() += mass.position.cross(momentum);
    }
    return h;
  }

  /// Energies [J]; gravity's is zero with all mass at the world's origin.
  SpaEnergy<T> Energy(const SpaState<T>& state, const SpaBase<T>& base) const {
    SpaEnergy<T> e{T(0.0), T(0.0), T(0.0)};
    for (const Mass& mass : Masses(state)) {
      e.kinetic += 0.5 * mass.amount * Velocity(mass, base).squaredNorm();
      const Vector3 place = base.p_WB + base.R_WB * mass.position;
      e.gravity -= mass.amount * options_.gravity.template cast<T>().dot(place);
    }
    for (int i = 0; i < 3; ++i) {
      const T x2 = state.delta[i] * state.delta[i];
      e.elastic += 0.5 * x2 *
                   ((i < 2 ? p_.k_theta : p_.k_dL1) + 0.5 * x2 * (i < 2 ? p_.k_theta3 : p_.k_dL3));
    }
    return e;
  }

 private:
  struct Place {
    double xi, weight;
  };  // xi < 0: the centre of gravity
  struct Mass {
    T amount;
    Vector3 position;
    Matrix3 jacobian;
    Vector3 velocity, bias;  // relative to the base: J δ̇ and J̇ δ̇
  };

  // Ten Gauss points integrate an arc up to a full circle to rounding.
  static std::vector<Place> Places(SpaMass mass) {
    if (mass == SpaMass::kCentroid) return {{-1, 1}};
    using Rule = boost::math::quadrature::gauss<double, 10>;
    std::vector<Place> places;
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      for (const double sign : {-1.0, 1.0}) {
        places.push_back({0.5 * (1 + sign * Rule::abscissa()[i]), 0.5 * Rule::weights()[i]});
      }
    }
    return places;
  }

  std::vector<Mass> Masses(const SpaState<T>& state) const { return Masses(state, p_.m); }
  std::vector<Mass> Masses(const SpaState<T>& state, const T& total) const {
    const Vec<T, 3> delta = Array(state.delta), rate = Array(state.rate);
    std::vector<Mass> masses;
    masses.reserve(places_.size());
    for (const auto& [xi, weight] : places_) {
      const PccPoint<T> point = xi < 0 ? PccCentroid(p_.Segment(), delta, rate)
                                       : PccCentreLine(p_.Segment(), xi, delta, rate);
      const Matrix3 jacobian = ToEigen(point.jacobian);
      masses.push_back({weight * total, ToEigen(point.position), jacobian, jacobian * state.rate,
                        ToEigen(point.jacobian_rate) * state.rate});
    }
    return masses;
  }

  static Vector3 Velocity(const Mass& mass, const SpaBase<T>& base) {
    return base.velocity + base.angular_velocity.cross(mass.position) + mass.velocity;
  }

  // Acceleration of the mass without the part of δ̈, less gravity.
  Vector3 Apparent(const Mass& mass, const SpaBase<T>& base) const {
    const Vector3& omega = base.angular_velocity;
    return base.acceleration - base.R_WB.transpose() * options_.gravity.template cast<T>() +
           base.angular_acceleration.cross(mass.position) +
           omega.cross(Vector3(omega.cross(mass.position) + 2.0 * mass.velocity)) + mass.bias;
  }

  Vector3 Material(const SpaState<T>& state) const {
    return ToEigen(PccSegmentLaw::Material(Array(state.delta), Array(state.rate), p_.Law()));
  }

  static Vec<T, 3> Array(const Vector3& v) { return {v[0], v[1], v[2]}; }
  static Vector3 ToEigen(const Vec<T, 3>& v) { return {v[0], v[1], v[2]}; }
  static Matrix3 ToEigen(const Mat3<T>& m) {
    Matrix3 e;
    for (int i = 0; i < 3; ++i) e.row(i) << m[i][0], m[i][1], m[i][2];
    return e;
  }
  static Matrix3 Cross(const Vector3& v) {
    Matrix3 m;
    m << T(0.0), -v[2], v[1], v[2], T(0.0), -v[0], -v[1], v[0], T(0.0);
    return m;
  }

  SpaParameters<T> p_;
  SpaOptions options_;
  std::vector<Place> places_;
};

/// The chamber pressure [Pa] a time h [s] after it was p, under the constant line pressure u:
/// T ṗ + p = u exactly; a lag of zero follows at once.
template <class T>
T SpaLag(const T& p, const T& u, double h, const T& lag) {
  return lag > 0.0 ? T(u + (p - u) * exp(-h / lag)) : u;
}

}  // namespace continuum
