#pragma once

#include <optional>
#include <vector>

#include "identification/problem/problem.h"
#include "identification/result/prediction_error.h"

namespace continuum {

/// Predicts the motion a few rows ahead from measured states, and compares with the measurement.
///
/// A prediction begins at every rows-th row (in long logs at a hundred rows), at the state measured
/// there (StateAt), and ends so many rows later. What the measured state lacks (activations, the
/// past of delays, friction and hysteresis) is taken from free simulation at that row. None where
/// the outputs do not give the state, or no log is as long.
std::optional<PredictionError> PredictAhead(const Problem& problem, const Problem::Vector& x,
                                            std::size_t rows);

}  // namespace continuum
