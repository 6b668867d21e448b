#pragma once

#include "effects/effect.h"

namespace continuum {

/// Bouc-Wen hysteresis: tendons in sheaths, braids, rubber.
///
///   τ = κ_w w                                                             (1)
///   ẇ = ρ (v − σ |v| |w|ⁿ⁻¹ w − (1 − η − σ) v |w|ⁿ)                       (2)
///
/// w [1] · κ_w [N*m], the torque in full sliding where there is one · ρ [1/rad]: κ_w ρ is the
/// stiffness at w = 0 · n ≥ 1 sharpness of the knee · σ ≥ ½ how much stiffer unloading is than
/// loading · η ≥ 0 hardening: 0 yields to a plateau, 1 not at all, and beyond it the law stiffens.
/// With u = w sgn(v) and over the path dx = ρ |v| dt, (2) is
///
///   du/dx = 1 − (1 − η) uⁿ          u ≥ 0  (loading)                      (3)
///   du/dx = 1 + (2σ − 1 + η) |u|ⁿ   u < 0  (unloading)                    (4)
///
/// η < 1: |w| ≤ (1 − η)^(−1/n). η ≥ 1: no bound; the force of a finite stroke is finite for n = 1,
/// as e^((η − 1) ρ x), but for n > 1 and η > 1 it passes all bounds at the path
/// (η − 1)^(−1/n) (π/n)/sin(π/n)/ρ from w = 0, and a simulation that gets there diverges.
///
/// Passive for all values within bounds, as (4) is never flatter than (3), by 2σ|u|ⁿ: with g
/// between the two slopes the energy ψ'(w) = κ_w w/(ρ g) is never created. Here
///
///   g = 1 + c |w|ⁿ,   c = 0 for η ≤ 1, else e + e/(1 + e) with e = η − 1  (5)
///
/// so that ψ = κ_w w²/(2ρ) and the loss is κ_w |v| |w|ⁿ⁺¹ (1 − η or 2σ − 1 + η) up to η = 1.
///
/// Of ż = A v − β |v| |z|ⁿ⁻¹ z − γ v |z|ⁿ in units of z = z₁ w it is ρ = A/z₁, σ = β z₁ⁿ/A and
/// 1 − η = (β + γ) z₁ⁿ/A. With η = 0 (z₁ the largest z) this is the normalized form, without a
/// redundant symbol, and n = σ = 1 is Dahl's law. It has no place for β + γ ≤ 0, which is what η is
/// for; then z₁ is free, and σ = ½, z₁ = (A/(2β))^(1/n), takes in all passive laws of this kind:
/// what a search does. The linear spring beside it is the joint's native stiffness.
/// Source: ikhouane2005; the model is of wen1976.
struct BoucWen {
  static constexpr std::string_view kName = "bouc_wen", kSource = "ikhouane2005",
                                    kSummary = "smooth hysteresis with a tunable knee";
  static constexpr Kinship kKin{kDryFriction, 1};
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array kStates{State{"w", "1"}};
  static constexpr std::array kParams{Magnitude("kappa_w", "N*m", 0.01),
                                      Positive("rho", "1/rad", 100),
                                      Param{"sigma", "1", 0.5, kInfinity, 1, kAsIs, 0.5},
                                      Param{"n", "1", 1, 20, 1, kAsIs}, Magnitude("eta", "1", 1)};

  template <class T>
  static Reply<T, 1> Eval(const Port<T>& q, const Vec<T, 1>& s, const Vec<T, 5>& p) {
    const auto& [w] = s;
    const auto& [kappa_w, rho, sigma, n, eta] = p;
    const double d = q.v < 0.0 ? -1 : 1;
    const T rate = rho * q.v * Slope(T(d * w), sigma, n, eta);                      // (2)
    return {kappa_w * w, {rate}, 0.5 * kappa_w / rho * w * w * Energy(w, n, eta)};  // (1)
  }

  /// (2) at constant v, over the path ρ |v| h, by Runge-Kutta steps short enough for 1e-7. Towards
  /// a plateau, u in units of it, (3) is
  ///   dy/dx = (1 − uⁿ)/(1 − u),   u = 1 − e^{−y}                          (6)
  /// where y has no end to come close to: (6) tends to n.
  template <class T>
  static Vec<T, 1> Step(const Vec<T, 1>& s, const Port<T>& q, double h, const Vec<T, 5>& p) {
    const auto& [w] = s;
    const auto& [kappa_w, rho, sigma, n, eta] = p;
    const double d = q.v < 0.0 ? -1 : 1;
    T u = d * w, path = rho * abs(q.v) * h;
    Unload(u, path, sigma, n, eta);
    if (1.0 - eta < kFlat) {
      Climb(u, path, n, eta);
    } else {
      const T plateau = exp(-log(1.0 - eta) / n);
      u = u / plateau;
      Load(u, path / plateau, n);
      u = plateau * u;
    }
    return {d * u};
  }

 private:
  static constexpr double kFine = 0.05, kSaturated = 10;
  static constexpr double kFlat = 0.05;  // 1 − η: plateaus that are so far off are walked to
  static constexpr double kTop = 1e30, kEnd = 1e-12;  // as good as infinite; as a plateau

  template <class T>
  static T Power(const T& u, const T& n) {
    const T a = abs(u);
    return a > 0.0 ? T(exp(n * log(a))) : T(0);
  }
  template <class T>
  static T Slope(const T& u, const T& sigma, const T& n, const T& eta) {
    return 1.0 + (u < 0.0 ? T(2.0 * sigma - 1.0 + eta) : T(eta - 1.0)) * Power(u, n);
  }

  // 2 ∫ t/(1 + a tⁿ) dt from 0 to 1, a = c |w|ⁿ of (5), by the series of the hypergeometric
  // function in a/(1 + a): ψ over its value at η = 0.
  template <class T>
  static T Energy(const T& w, const T& n, const T& eta) {
    if (!(eta > 1.0)) return T(1);
    constexpr int kTerms = 100000;  // enough for a = 1000
    const T e = eta - 1.0, a = (e + e / (1.0 + e)) * Power(w, n), z = a / (1.0 + a);
    T term = 1.0 / (1.0 + a), sum = term;
    for (int k = 1; k < kTerms && term > 1e-17 * sum; ++k) {
      term = term * z * (k / (k + 2.0 / n));
      sum = sum + term;
    }
    return sum;
  }

  template <class T, class F>
  static T Walk(const T& u, const T& dx, const F& slope) {
    const T a = slope(u), b = slope(T(u + 0.5 * dx * a)), c = slope(T(u + 0.5 * dx * b));
    return u + dx / 6.0 * (a + 2.0 * b + 2.0 * c + slope(T(u + dx * c)));
  }

  // Takes from the path what leads along (4), at most up to u = 0.
  template <class T>
  static void Unload(T& u, T& path, const T& sigma, const T& n, const T& eta) {
    const auto slope = [&](const T& at) { return 1.0 + (2.0 * sigma - 1.0 + eta) * Power(at, n); };
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

  // Walks the path along (3) where there is no plateau to come close to.
  template <class T>
  static void Climb(T& u, const T& path, const T& n, const T& eta) {
    const auto slope = [&](const T& at) { return 1.0 + (eta - 1.0) * Power(at, n); };
    T left = path;
    while (left > 0.0 && slope(u) > kEnd) {
      T dx = kFine / (1.0 / (1.0 + u) + n * abs(T(eta - 1.0)) * Power(u, T(n - 1.0)));
      if (left < dx) dx = left;
      u = Walk(u, dx, slope);
      left = left - dx;
      if (u > kTop) u = T(kInfinity), left = T(0);  // the end of its path
    }
  }

  // Walks the path along (6); from kSaturated on its slope is n to 1e-9 of u.
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
