#pragma once

#include <algorithm>
#include <cmath>

#include "models/statics/dual_value.h"

namespace continuum::statics {

/// The share s of its largest friction with which a contact resists, -1..1, after it has slid by x
/// (in units of eps) from a state s_0: ds/dx = 1 - s^2 while it slides on, ds/dx = 1 while friction
/// of the way before still pulls it back. From rest, s_0 = 0, this is s = tanh x. The way may be
/// cut into parts: the state after the first is s_0 of the second.
template <class T>
T SlideFrom(double s_0, const T& x) {
  using std::tanh;
  constexpr double kSaturated = 19;  // tanh is 1 from here on
  if (s_0 == 0) return tanh(x);
  if (Value(x) < 0) return -SlideFrom(-s_0, T(-x));
  const double begin = s_0 < 0 ? s_0 : std::min(std::atanh(std::min(s_0, 1.0)), kSaturated);
  const T phase = begin + x;
  return Value(phase) < 0 ? phase : tanh(phase);
}

}  // namespace continuum::statics
