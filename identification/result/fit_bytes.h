#pragma once

#include "identification/result/fit.h"

/// Fits for BytesOut and BytesIn (sim/numerics/bytes.h).
namespace continuum {

template <class A>
void Fields(A& a, Fit& f) {
  auto& [x, cost, iterations, evaluations, seconds, converged, anew, over_pieces, smooth, message,
         trace] = f;
  a(x, cost, iterations, evaluations, seconds, converged, anew, over_pieces, smooth, message,
    trace);
}

}  // namespace continuum
