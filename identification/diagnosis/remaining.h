#pragma once

#include <string>

#include "identification/diagnosis/result.h"

namespace continuum {

/// How much of a fitted model's error is left over the noise, and where most of it is: the channel
/// and the log with the largest error. would_take is not filled in.
Remaining RemainingOf(const Problem& problem, const Fitted& fitted, const Noise& noise);

/// Whether the error of a best candidate, or of the model where there is none, is model error:
/// tests of the residual see nothing where nothing moves.
bool LeavesMuch(const Diagnosis& diagnosis, const CandidateResult* best);

/// What would take what a verdict leaves, in words: a smooth force, a shift or constants of the
/// channels, or one of them beside its leading candidate; empty where no test shows anything.
std::string WouldTake(const Diagnosis& diagnosis);

}  // namespace continuum
