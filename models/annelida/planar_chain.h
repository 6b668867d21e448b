#pragma once

#include <array>

#include <Eigen/Dense>

#include "models/annelida/annelida.h"

namespace continuum {

using PlanarJoints = Eigen::Matrix<double, kAnnelidaLinks, 1>;  ///< bend1_y .. bend5_y

/// Motion of the snake arm in the plane of cables 1 and 3.
struct PlanarState {
  PlanarJoints q = PlanarJoints::Zero(), v = PlanarJoints::Zero();  ///< [rad], [rad/s]
  PlanarJoints bristle = PlanarJoints::Zero();  ///< deflection of the joints' friction [rad]
  std::array<PlanarJoints, 2> grip{PlanarJoints::Zero(),
                                   PlanarJoints::Zero()};  ///< of cables 1, 3 at the holes [m]
};

/// The same arm without MuJoCo: equations of motion of five links in a plane, written out.
///
///   M(q) q̈ + c(q, q̇) + g(q) + K q + τ_μ q̇ + F = −Σ_j T_ji dℓ_ji/dq_i
///   ℓ_ji = 2 (b1 cos(q_i/2) ∓ a sin(q_i/2))
///
/// F is Stribeck friction and T_ji the tension after capstan friction, both elasto-plastic: a
/// bristle of 5 µrad (joint) or 1 µm (cable in a hole) deflects until it carries the friction of
/// sliding. Integrated by semi-implicit Euler; meant for steps of 20 µs or less. Source: snake_arm,
/// eqs. 6-8.
class PlanarChain {
 public:
  /// payload: point mass at the tip [kg]; tilt: pitch of gravity [rad], R_y of it as the world
  /// sees.
  explicit PlanarChain(const AnnelidaParameters& p, double payload = 0, double tilt = 0)
      : p_(p), payload_(payload), tilt_(tilt) {}

  /// tension: of cables 1 and 3 at the base [N].
  void Step(PlanarState& state, const std::array<double, 2>& tension, double h) const;

  /// World x and z of the tip [m].
  Eigen::Vector2d Tip(const PlanarJoints& q) const;
  /// World x and z of base, joints 1 .. 5 and tip [m].
  Eigen::Matrix<double, 2, kAnnelidaLinks + 2> Points(const PlanarJoints& q) const;
  /// Kinetic, potential and spring energy [J]; without tilt.
  double Energy(const PlanarState& state) const;

 private:
  struct Equations {
    Eigen::Matrix<double, kAnnelidaLinks, kAnnelidaLinks> M;
    PlanarJoints bias;  ///< c + g
  };
  Equations At(const PlanarJoints& q, const PlanarJoints& v) const;
  PlanarJoints CableTorque(PlanarState& state, int cable, double tension, double h) const;
  PlanarJoints Friction(PlanarState& state, double h) const;

  AnnelidaParameters p_;
  double payload_, tilt_;
};

}  // namespace continuum
