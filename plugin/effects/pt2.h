#pragma once

#include "effects/effect.h"

namespace continuum {

/// Second-order lag of the input: an inner control loop, a valve, a column of air.
///
///   ÿ + 2 ζ ω ẏ + ω² y = ω² u                                             (1)
///
/// w = ω [rad/s] · zeta = ζ [1] · states y and ẏ, at rest 0. w = inf is the input itself. It acts
/// before lag, gain and offset of the actuator and after its dead time.
/// Source: ogata2010.
struct Pt2 {
  static constexpr std::string_view kName = "pt2", kSource = "ogata2010",
                                    kSummary = "an input with a second-order lag";
  static constexpr Kinship kKin{kLateness, 1};
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr Tap kTap = Tap::kInput;
  static constexpr std::array kStates{State{"y", "input"}, State{"dy", "input/s"}};
  static constexpr std::array kParams{
      Param{"w", "rad/s", std::numeric_limits<double>::min(), kInfinity, 60, kInfinity},
      Positive("zeta", "1", 0.7)};

  template <class T>
  static T Eval(const T& u, const Vec<T, 2>& s, const Vec<T, 2>& p) {
    return p[0] < kInfinity ? s[0] : u;
  }

  /// (1) at constant u: with e = y − u, x = ω h and δ² = ζ² − 1
  ///   e(h) = exp(−ζ x) (e C + (ė/ω + ζ e) S),   ė(h) = exp(−ζ x) (ė C − (ζ ė + ω e) S)
  /// where C = cosh(δ x) and S = sinh(δ x)/δ, also for imaginary δ. No power of ω stands alone: it
  /// may be as large as a number can be.
  template <class T>
  static Vec<T, 2> Step(const Vec<T, 2>& s, const T& u, double h, const Vec<T, 2>& p) {
    const auto& [w, zeta] = p;
    if (!(w < kInfinity)) return {u, T(0)};
    const T e = s[0] - u, rate = s[1], x = w * h;
    const T square = ((zeta - 1.0) * x) * ((zeta + 1.0) * x);
    T C, S;  // each times exp(−ζ x)
    if (square > kSmall) {
      const T delta = sqrt(zeta - 1.0) * sqrt(zeta + 1.0);
      const T slow = exp(-x / (zeta + delta)), fast = exp(-(zeta + delta) * x);
      C = 0.5 * (slow + fast), S = 0.5 * (slow - fast) / delta;
    } else if (square < -kSmall) {
      const T delta = sqrt(1.0 - zeta) * sqrt(1.0 + zeta), decay = exp(-zeta * x);
      C = decay * cos(delta * x), S = decay * sin(delta * x) / delta;
    } else {  // near critical damping
      const T decay = exp(-zeta * x);
      C = decay * (1.0 + 0.5 * square), S = decay * x * (1.0 + square / 6.0);
    }
    return {u + e * C + (rate / w + zeta * e) * S, rate * (C - zeta * S) - (w * S) * e};
  }

 private:
  static constexpr double kSmall = 1e-7;  // the next terms of the series are below 1e-15
};

}  // namespace continuum
