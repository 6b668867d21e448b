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

  /// (1) at constant u: with e = y − u, a = ζω and d² = a² − ω²
  ///   e(h) = exp(−a h) (e C + (ė + a e) S),   ė(h) = exp(−a h) (ė C − (a ė + ω² e) S)
  /// where C = cosh(d h) and S = sinh(d h)/d, also for imaginary d.
  template <class T>
  static Vec<T, 2> Step(const Vec<T, 2>& s, const T& u, double h, const Vec<T, 2>& p) {
    const auto& [w, zeta] = p;
    if (!(w < kInfinity)) return {u, T(0)};
    const T e = s[0] - u, rate = s[1], a = zeta * w, square = a * a - w * w;
    T C, S;  // each times exp(−a h)
    if (square * h * h > kSmall) {
      const T d = sqrt(square), slow = exp((d - a) * h), fast = exp(-(d + a) * h);
      C = 0.5 * (slow + fast), S = 0.5 * (slow - fast) / d;
    } else if (square * h * h < -kSmall) {
      const T d = sqrt(-square), decay = exp(-a * h);
      C = decay * cos(d * h), S = decay * sin(d * h) / d;
    } else {  // near critical damping
      const T x = square * h * h, decay = exp(-a * h);
      C = decay * (1.0 + 0.5 * x), S = decay * h * (1.0 + x / 6.0);
    }
    return {u + e * C + (rate + a * e) * S, rate * C - (a * rate + w * w * e) * S};
  }

 private:
  static constexpr double kSmall = 1e-7;  // the next terms of the series are below 1e-15
};

}  // namespace continuum
