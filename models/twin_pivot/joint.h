#pragma once

#include <ceres/jet.h>

#include <array>
#include <cmath>

#include "models/statics/dual_value.h"
#include "models/twin_pivot/robot.h"

namespace continuum::twin_pivot {

using statics::Value;

/// g(x) from its value and slope at x, so that a dual number pays for one product only.
inline double Lift(double value, double /*slope*/, double /*x*/) { return value; }
template <int N>
ceres::Jet<double, N> Lift(double value, double slope, const ceres::Jet<double, N>& x) {
  return {value, slope * x.v};
}

/// c_k(b) = sum_i (-b^2)^i / (k + 2 i)!, k = 0..5: cos b, sin b / b, (1 - cos b)/b^2, ... The
/// geometry of an arc written in them has no singular point at b = 0 and needs no branch there.
///
/// Power series for k = 6, 7, then c_k = 1/k! - b^2 c_k+2 downward: absolute errors of a few 1e-16
/// for |b| <= pi. dc_k/db = b (k c_k+2 - c_k+1).
template <class T>
std::array<T, 6> Stumpff(const T& b) {
  constexpr std::array<double, 6> kInverseFactorial = {1, 1, 0.5, 1.0 / 6, 1.0 / 24, 1.0 / 120};
  const double x = Value(b) * Value(b);
  std::array<double, 8> c{};
  for (int k = 6; k <= 7; ++k) {
    double sum = 1;
    for (int i = 24 + k; i > k; i -= 2) sum = 1 - x * sum / (i * (i - 1));
    c[k] = k == 6 ? sum / 720 : sum / 5040;
  }
  for (int k = 5; k >= 0; --k) c[k] = kInverseFactorial[k] - x * c[k + 2];
  std::array<T, 6> lifted;
  for (int k = 0; k < 6; ++k) lifted[k] = Lift(c[k], Value(b) * (k * c[k + 2] - c[k + 1]), b);
  return lifted;
}

/// A point or vector in the plane in which a joint bends.
template <class T>
struct Planar {
  T x, y;
};

/// Joint m in the frame of disc m-1 (x along the disc's normal, bending about z by beta): what
/// depends on beta alone. Rod from (h/2, 0), h the thickness
/// of disc m-1, an arc of length L; cable j at distance y from the
/// bending axis, a straight line from the distal face of disc m-1 to the proximal face of disc m.
template <class T>
struct Joint {
  T beta, cosine, sine;      ///< of beta
  T half_cosine, half_sine;  ///< of beta/2
  Planar<T> origin;          ///< O_m
  Planar<T> rod_end;
  Planar<T> centre;        ///< centroid of the rod = instantaneous centre of all beyond it, (29)
  Planar<T> centre_slope;  ///< its derivative by beta
  T chord;                 ///< 2 (L/beta) sin(beta/2)
  T bend;                  ///< -d chord/d beta

  Joint(const Link& link, const T& b) : beta(b) {
    const double L = link.L;
    const std::array<T, 6> c = Stumpff(b);
    const T u = 0.5 * b;
    const std::array<T, 6> d = Stumpff(u);
    cosine = c[0];
    sine = b * c[1];
    half_cosine = d[0];
    half_sine = u * d[1];
    rod_end = {link.before + L * c[1], L * b * c[2]};
    origin = {rod_end.x + link.after * cosine, rod_end.y + link.after * sine};
    centre = {link.before + L * c[2], L * b * c[3]};
    centre_slope = {L * b * (2.0 * c[4] - c[3]), L * (c[3] + b * b * (3.0 * c[5] - c[4]))};
    chord = L * d[1];
    bend = 0.5 * L * u * (d[2] - d[3]);
  }

  /// l_mj = 2 (L/beta - y) sin(beta/2)
  T Length(double y) const { return chord - 2.0 * y * half_sine; }
  /// -dl_mj/dbeta = y cos(beta/2) + L (2 sin(beta/2)/beta^2 - cos(beta/2)/beta)
  T Arm(double y) const { return y * half_cosine + bend; }
  /// The hole on the proximal face of disc m.
  Planar<T> Hole(double y) const { return {rod_end.x - y * sine, rod_end.y + y * cosine}; }
};

/// Friction between a cable and the disc on either side of a joint, as a share of the tension:
/// w = mu(theta) sin(theta), theta = |beta|/2. The kink at beta = 0 gets the slope of its middle,
/// 0.
template <class T>
T FrictionShare(const Friction& friction, const T& beta) {
  const double theta = 0.5 * std::abs(Value(beta));
  const double direction = (Value(beta) > 0) - (Value(beta) < 0);
  const double mu = friction.At(theta);
  const double slope = friction.Slope(theta) * std::sin(theta) + mu * std::cos(theta);
  return Lift(mu * std::sin(theta), 0.5 * direction * slope, beta);
}

}  // namespace continuum::twin_pivot
