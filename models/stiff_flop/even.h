#pragma once

#include <ceres/jet.h>

#include <array>
#include <cmath>

#include "models/statics/dual_value.h"

namespace continuum::stiff_flop {

using statics::Value;

/// sqrt(a^2 + b^2) as argument of a function that is *even* in it. At 0, where the root has no
/// derivative, an even function has derivative 0 in every direction: any of them will do.
template <class T>
T Magnitude(const T& a, const T& b) {
  using std::sqrt;
  if (std::hypot(Value(a), Value(b)) < 1e-100) return a;
  return sqrt(a * a + b * b);
}

/// c_k(x) = sum_i (-x^2)^i / (k + 2 i)! for k = 0..3: cos x, sin x / x, (1 - cos x)/x^2 and
/// (x - sin x)/x^3, with which an arc has no singular point at x = 0. Relative errors below 1e-14.
template <class T>
std::array<T, 4> ArcSeries(const T& x) {
  using std::cos;
  using std::sin;
  const T square = x * x;
  if (std::abs(Value(x)) > 1) {
    const T c = cos(x);
    const T s = sin(x) / x;
    return {c, s, (1.0 - c) / square, (1.0 - s) / square};
  }
  std::array<T, 4> c;
  for (int k = 2; k <= 3; ++k) {
    T sum(1.0);
    for (int i = 18 + k; i > k; i -= 2) sum = 1.0 - square * sum / static_cast<double>(i * (i - 1));
    c[k] = sum / (k == 2 ? 2.0 : 6.0);
  }
  c[0] = 1.0 - square * c[2];
  c[1] = 1.0 - square * c[3];
  return c;
}

/// Stretch and curvature [1/m] of an axis.
template <class T>
struct Bend {
  T lambda, kappa;

  Bend<double> value() const { return {Value(lambda), Value(kappa)}; }
};

/// The axis of a module where its section is looked at: stretch lambda and curvature
/// (k_1, k_2) = kappa (cos phi, sin phi) [1/m], regular where phi is not.
template <class T>
struct Axis {
  T lambda, k_1, k_2;

  Bend<T> bend() const { return {lambda, Magnitude(k_1, k_2)}; }
  Axis<double> value() const { return {Value(lambda), Value(k_1), Value(k_2)}; }
};

/// f of two arguments, known with its two partial derivatives, as a number of the caller's kind:
/// long sums then run on short dual numbers.
inline double Lift(const ceres::Jet<double, 2>& f, double, double) { return f.a; }
template <int N>
ceres::Jet<double, N> Lift(const ceres::Jet<double, 2>& f, const ceres::Jet<double, N>& a,
                           const ceres::Jet<double, N>& b) {
  return {f.a, f.v[0] * a.v + f.v[1] * b.v};
}

}  // namespace continuum::stiff_flop
