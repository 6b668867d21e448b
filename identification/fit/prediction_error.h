#pragma once

#include <optional>
#include <vector>

#include "identification/problem/problem.h"
#include "identification/result/prediction_error.h"

namespace continuum {

/// How well a model goes on with a measured motion: it starts anew at every rows-th row (in long
/// logs at a hundred rows), from the state measured there (StateAt), and is compared with the
/// measurement so many rows later. What the state does not tell (activations, the past of delays,
/// friction and hysteresis) is what free simulation has there.
///
/// None where the outputs do not give the state, or no log is as long.
std::optional<PredictionError> PredictAhead(const Problem& problem, const Problem::Vector& x,
                                            std::size_t rows);

}  // namespace continuum
