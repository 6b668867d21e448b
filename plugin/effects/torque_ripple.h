#pragma once

#include "effects/effect.h"

namespace continuum {

/// Torque that repeats over the turn: cogging of a motor, a pulley or a gear that is not round.
///
///   τ = a cos(n q) + b sin(n q)                                             (1)
///   ψ = (a sin(n q) + b (1 − cos(n q)))/n        stored                     (2)
///
/// a, b [N*m] · n [1/rad] periods in 2π of the joint; on a slide joint 2π over the pitch. It takes
/// and gives back: no loss. No candidate by itself: below a few periods a spring, a bias or a
/// friction over the angle says the same. Source: mattavelli2005.
struct TorqueRipple {
  static constexpr std::string_view kName = "torque_ripple", kSource = "mattavelli2005",
                                    kSummary = "torque that repeats over the turn";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array<State, 0> kStates{};
  static constexpr std::array kParams{Signed("a", "N*m", 0.01), Signed("b", "N*m", 0.01),
                                      Positive("n", "1/rad", 6)};

  template <class T>
  static Reply<T, 0> Eval(const Port<T>& q, const Vec<T, 0>&, const Vec<T, 3>& p) {
    const auto& [a, b, n] = p;
    const T c = cos(n * q.x), s = sin(n * q.x);
    return {a * c + b * s, {}, (a * s + b * (1.0 - c)) / n};  // (1), (2)
  }
  template <class T>
  static Vec<T, 0> Step(const Vec<T, 0>& z, const Port<T>&, double, const Vec<T, 3>&) {
    return z;
  }
};

}  // namespace continuum
