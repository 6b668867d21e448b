#pragma once

#include "identification/trial.h"

namespace continuum {

/// Compares fitted candidates where the model leaves more than noise, or nobody knows the noise:
/// only what holds on logs left out counts, beside random forces and the best smooth force. Orders
/// the candidates and fills in records, ceiling and verdict.
void CompareByFolds(const Trials& trials, const DiagnosisOptions& options, Diagnosis& diagnosis);

/// One candidate's record over the folds; the model's own before it.
void RecordFolds(const Trials& trials, const Diagnosis& diagnosis, CandidateResult& candidate);

}  // namespace continuum
