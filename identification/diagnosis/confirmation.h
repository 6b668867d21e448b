#pragma once

#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// Whether what shows in the logs is smaller than noise and time step make together, and the best
/// explanation leaves no more than that. best: its squares over those of noise, root.
bool IsSmallerThanNoise(const Diagnosis& d, double best);

/// Takes a name by likelihoods back where it does not help on logs left out. One that leaves
/// nothing but noise may have found that in the noise: it is judged on the validate logs, in units
/// of the noise. So is a name that leaves more than noise, where it takes less than fold_share of
/// what the validate logs show above it.
void ConfirmOnFolds(const CandidateFitter& fitter, Diagnosis& d);

/// Takes a name by folds back where it raises the error of the validate logs, or takes little of it
/// as above: folds are made of train logs.
void ConfirmOnValidateLogs(Diagnosis& d);

}  // namespace continuum
