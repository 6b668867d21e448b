#pragma once

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// Compares fitted candidates by cross-validation, where the residual of the best model is more
/// than noise or nobody knows the noise: only what holds on logs left out counts, beside random
/// forces and the best of them. Orders the candidates and fills in records, ceiling and verdict.
/// given: free parameters of a cause that the model before has already.
void CompareByFolds(const CandidateFitter& fitter, const DiagnosisOptions& options,
                    Diagnosis& diagnosis, const std::vector<Parameter>& given = {});

/// The verdict by likelihoods stands, incomplete, where more than noise is left and there are no
/// logs to leave out on which a name could be tried.
void LeaveWithoutFolds(Diagnosis& diagnosis);

/// Takes what something reached on the folds for the ceiling where it is more than was known.
void RaiseCeiling(Diagnosis& diagnosis, const std::string& by, const FoldScores& folds,
                  const TwoErrors& error);

/// Error of the model as it is, where it was fitted or on logs left out, whichever is larger, over
/// the scatter from row to row; 0 where noise is known better.
double OverScatter(const Diagnosis& diagnosis);

/// What of the error the ceiling takes off, median over the folds.
double CeilingGain(const Diagnosis& diagnosis);

/// One candidate's record over the folds; the model's own before it.
void RecordFolds(const CandidateFitter& fitter, const Diagnosis& diagnosis,
                 CandidateResult& candidate);

}  // namespace continuum
