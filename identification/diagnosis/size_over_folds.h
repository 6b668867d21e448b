#pragma once

#include <vector>

#include "identification/diagnosis/result.h"

namespace continuum {

/// How large a law is in every fold, as the size of its main parameter that does as much: with a
/// its amplitudes, counted from absence, and J what they do to the outputs at the fit of all logs,
///
///   a_main (J a_fold)ᵀ (J a) / |J a|².
///
/// Of one amplitude that is its value. Of several that do much the same, as the levels of a
/// friction at rest and under load, each may be anything while the law stays what it is.
/// candidate: with sensitivities and the fits of its folds.
std::vector<double> SizeOverFolds(const CandidateResult& candidate);

}  // namespace continuum
