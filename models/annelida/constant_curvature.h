#pragma once

#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace continuum {

/// An arc of constant curvature in Allen's parameters: w = (u, v, 0) [rad], arc length s [m].
///
///   θ = s κ = ‖w‖,   φ = atan2(−u, v),   (u, v) = θ (−sin φ, cos φ)             (1)
///
/// Straight along z at u = v = 0; φ is the azimuth toward which it bends. Source: snake_arm, eqs.
/// 1-5; where the print is wrong or singular, the comment says so.
struct Arc {
  double u = 0, v = 0, s = 0;

  double Angle() const { return std::hypot(u, v); }
  double Azimuth() const { return std::atan2(-u, v); }
  double Curvature() const { return Angle() / s; }
  static Arc Of(double azimuth, double angle, double s) {
    return {-angle * std::sin(azimuth), angle * std::cos(azimuth), s};
  }
};

/// sin(x)/x, smooth through 0.
inline double Sinc(double x) {
  const double x2 = x * x;
  return std::abs(x) < 1e-3 ? 1 - x2 / 6 * (1 - x2 / 20) : std::sin(x) / x;
}

/// Pose of an arc's distal frame in its proximal one, with ξ = sinc θ, γ = ½ sinc²(θ/2):
///
///   R = [1 − γv², γuv, ξv; γuv, 1 − γu², −ξu; −ξv, ξu, cos θ],  p = s (γv, −γu, ξ)    (2)
///
/// (The print has ξ for γ on the diagonal and other signs.)
inline Eigen::Isometry3d ArcPose(const Arc& arc) {
  const double u = arc.u, v = arc.v, theta = arc.Angle();
  const double xi = Sinc(theta), half = Sinc(theta / 2), gamma = 0.5 * half * half;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 1 - gamma * v * v, gamma * u * v, xi * v,  //
      gamma * u * v, 1 - gamma * u * u, -xi * u,              //
      -xi * v, xi * u, std::cos(theta);
  pose.translation() = arc.s * Eigen::Vector3d(gamma * v, -gamma * u, xi);
  return pose;
}

/// The arc from the origin along z to a point p with p_z > −‖p‖:
///
///   φ = atan2(p_y, p_x),   κ = 2 √(p_x² + p_y²)/‖p‖²,   θ = arccos(1 − κ √(p_x² + p_y²))    (3)
///
/// (κ is printed without the square.) Written with atan2, it holds for θ in [0, 2π) and straight.
inline Arc ArcTo(const Eigen::Vector3d& p) {
  const double r = p.head<2>().norm();
  const double half = std::atan2(r, p.z());  // the chord leaves the tangent at θ/2
  return Arc::Of(std::atan2(p.y(), p.x()), 2 * half, p.norm() / Sinc(half));
}

using CableLengths = std::array<double, 4>;

/// A module: a joint between two discs with four holes at radius a, 90° apart, in planes at the
/// distance b before and behind the joint. n equal modules bend as one section.
struct Module {
  double a, b;
  int n = 1;

  /// Lengths of the four cables over all n modules when the section turns by θ toward φ:
  ///
  ///   ℓ_j = ‖T c_j − c_j‖ = 2 (b cos(θ/2n) − a cos(φ − φ_j) sin(θ/2n)) per module      (4)
  CableLengths Lengths(double azimuth, double angle) const {
    const double half = angle / (2 * n);
    CableLengths lengths;
    for (int j = 0; j < 4; ++j) {
      const double side = a * std::cos(azimuth - j * M_PI / 2);
      lengths[j] = 2 * n * (b * std::cos(half) - side * std::sin(half));
    }
    return lengths;
  }

  /// Azimuth φ, curvature κ [1/m] and angle θ from cable lengths with ℓ_1 + ℓ_3 = ℓ_2 + ℓ_4:
  ///
  ///   φ = atan2(ℓ_4 − ℓ_2, ℓ_3 − ℓ_1),   κ = 2 √((ℓ_4 − ℓ_2)² + (ℓ_3 − ℓ_1)²)/(a Σℓ),
  ///   θ = 2 n atan(κ b)                                                              (5)
  ///
  /// From (4): Σℓ = 8 n b cos(θ/2n) and the root is 4 n a sin(θ/2n), so that κ = tan(θ/2n)/b. (As
  /// printed κ is singular at ℓ_4 = ℓ_2, and the third line, divided by κ, is the arc length.)
  struct Bend {
    double azimuth, curvature, angle;
  };
  Bend FromLengths(const CableLengths& l) const {
    const double y = l[3] - l[1], x = l[2] - l[0];
    const double curvature = 2 * std::hypot(x, y) / (a * (l[0] + l[1] + l[2] + l[3]));
    return {std::atan2(y, x), curvature, 2 * n * std::atan(curvature * b)};
  }
};

}  // namespace continuum
