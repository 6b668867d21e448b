#pragma once

#include "effects/effect.h"

namespace continuum {

/// Bouc-Wen hysteresis: tendons in sheaths, braids, rubber.
///
///   τ = κ_w w                                                             (1)
///   ẇ = ρ (v − σ |v| |w|ⁿ⁻¹ w − (1 − σ) v |w|ⁿ)                           (2)
///   ψ = κ_w w²/(2ρ)              loss κ_w |v| |w|ⁿ⁺¹ (σ ± (1 − σ)) ≥ 0    (3)
///
/// w [1], |w| ≤ 1 · κ_w [N*m] torque in full sliding · ρ [1/rad]: κ_w ρ is the stiffness at w = 0 ·
/// n ≥ 1 sharpness of the knee · σ ≥ ½ shape of unloading (½: straight). This is the normalized
/// form of ż = A v − β |v| |z|ⁿ⁻¹ z − γ v |z|ⁿ: with z_max = (A/(β + γ))^(1/n), w = z/z_max, ρ =
/// A/z_max, σ = β/(β + γ). It has no redundant symbol, and σ ≥ ½ is what makes it passive; n = 1
/// and σ = 1 is Dahl's law. The linear spring beside it is the joint's native stiffness.
/// Source: ikhouane2005; the model is of wen1976.
struct BoucWen {
  static constexpr std::string_view kName = "bouc_wen", kSource = "ikhouane2005",
                                    kSummary = "smooth hysteresis with a tunable knee";
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array kStates{State{"w", "1"}};
  static constexpr std::array kParams{
      Magnitude("kappa_w", "N*m", 0.01), Positive("rho", "1/rad", 100),
      Param{"sigma", "1", 0.5, kInfinity, 1, kAsIs}, Param{"n", "1", 1, 20, 1, kAsIs}};

  template <class T>
  static Reply<T, 1> Eval(const Port<T>& q, const Vec<T, 1>& s, const Vec<T, 4>& p) {
    const auto& [w] = s;
    const auto& [kappa_w, rho, sigma, n] = p;
    const double d = q.v < 0.0 ? -1 : 1;
    const T rate = rho * q.v * Slope(T(d * w), sigma, n);       // (2)
    return {kappa_w * w, {rate}, 0.5 * kappa_w / rho * w * w};  // (1), (3)
  }

  /// (2) at constant v, over the path ρ |v| h, by Runge-Kutta steps short enough for 1e-7. With
  /// u = w sgn(v) it is
  ///   du/dx = 1 + (2σ − 1) |u|ⁿ   u < 0  (unloading)                      (4)
  ///   dy/dx = (1 − uⁿ)/(1 − u)    u ≥ 0, u = 1 − e^{−y}                   (5)
  /// where y has no end to come close to: (5) tends to n.
  template <class T>
  static Vec<T, 1> Step(const Vec<T, 1>& s, const Port<T>& q, double h, const Vec<T, 4>& p) {
    const auto& [w] = s;
    const auto& [kappa_w, rho, sigma, n] = p;
    const double d = q.v < 0.0 ? -1 : 1;
    T u = d * w, path = rho * abs(q.v) * h;
    Unload(u, path, sigma, n);
    Load(u, path, n);
    return {d * u};
  }

 private:
  static constexpr double kFine = 0.05, kSaturated = 10;

  template <class T>
  static T Power(const T& u, const T& n) {
    const T a = abs(u);
    return a > 0.0 ? T(exp(n * log(a))) : T(0);
  }
  template <class T>
  static T Slope(const T& u, const T& sigma, const T& n) {
    return 1.0 + (u < 0.0 ? T(2.0 * sigma - 1.0) : T(-1)) * Power(u, n);
  }

  template <class T, class F>
  static T Walk(const T& u, const T& dx, const F& slope) {
    const T a = slope(u), b = slope(T(u + 0.5 * dx * a)), c = slope(T(u + 0.5 * dx * b));
    return u + dx / 6.0 * (a + 2.0 * b + 2.0 * c + slope(T(u + dx * c)));
  }

  // Takes from the path what leads along (4), at most up to u = 0.
  template <class T>
  static void Unload(T& u, T& path, const T& sigma, const T& n) {
    const auto slope = [&](const T& at) { return 1.0 + (2.0 * sigma - 1.0) * Power(at, n); };
    while (u < 0.0 && path > 0.0) {
      T dx = kFine / (1.0 + n * (slope(u) - 1.0) / abs(u));
      if (path < dx) dx = path;
      T next = Walk(u, dx, slope);
      if (next > 0.0) {
        for (int i = 0; i < 4; ++i) {
          dx = dx - next / slope(next);
          next = Walk(u, dx, slope);
        }
        next = T(0);
      }
      u = next;
      path = path - dx;
    }
  }

  // Walks the path along (5); from kSaturated on its slope is n to 1e-9 of u.
  template <class T>
  static void Load(T& u, const T& path, const T& n) {
    if (!(path > 0.0) || u >= 1.0) return;
    const auto slope = [&](const T& at) {
      const T rest = exp(-at);
      return (1.0 - Power(T(1.0 - rest), n)) / rest;
    };
    T y = -log(1.0 - u), left = path;
    while (left > 0.0 && y < kSaturated) {
      T dx = kFine * (1.0 + y) / slope(y);
      if (left < dx) dx = left;
      y = Walk(y, dx, slope);
      left = left - dx;
    }
    u = 1.0 - exp(-(y + n * left));
  }
};

}  // namespace continuum
