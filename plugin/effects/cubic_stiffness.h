#pragma once

#include "effects/effect.h"

namespace continuum {

/// Spring that stiffens (k3 > 0) or softens (k3 < 0) with its displacement.
///
///   τ = −k3 x³,  x = q − springref                                        (1)
///   ψ = ¼ k3 x⁴                                                           (2)
///
/// k3 [N*m/rad^3] · x [rad] displacement from the rest position of the joint's native spring, which
/// keeps its linear part. Equal to the third coefficient of MuJoCo's own stiffness="a b c".
/// Source: duffing1918.
struct CubicStiffness {
  static constexpr std::string_view kName = "cubic_stiffness", kSource = "duffing1918",
                                    kSummary = "a spring that stiffens with its displacement";
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array<State, 0> kStates{};
  static constexpr std::array kParams{Signed("k3", "N*m/rad^3", 0.1)};

  template <class T>
  static Reply<T, 0> Eval(const Port<T>& q, const Vec<T, 0>&, const Vec<T, 1>& p) {
    const auto& [k3] = p;
    const T square = q.x * q.x;
    return {k3 * square * q.x, {}, 0.25 * k3 * square * square};  // (1), (2)
  }

  template <class T>
  static Vec<T, 0> Step(const Vec<T, 0>& s, const Port<T>&, double, const Vec<T, 1>&) {
    return s;
  }
};

}  // namespace continuum
