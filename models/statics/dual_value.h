#pragma once

#include <ceres/jet.h>

namespace continuum::statics {

/// A number without its derivatives.
inline double Value(double x) { return x; }
template <int N>
double Value(const ceres::Jet<double, N>& x) {
  return x.a;
}

}  // namespace continuum::statics
