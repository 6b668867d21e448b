#pragma once

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// The input that best distinguishes the models of an ambiguous verdict.
///
/// Simulates the chosen candidate under several changes of a train log's inputs, and lets every
/// rival of the set refit that to first order, and the other way round. separation: of the input
/// with the largest one for the closest rival, what no refit takes away, in units of twice the
/// log-likelihood where the noise is known (else of the mean square of the residual, for want of
/// better):
///
///   λ = |M W (y_rival − y_chosen)|²
///
/// Below Criteria::separation no change of the inputs distinguishes them.
NextExperiment ProposeNext(const CandidateFitter& fitter, const Diagnosis& diagnosis);

/// Its inputs from t = 0, in the columns and units of the experiment.
std::string NextCsv(const Experiment& experiment, const Log& next);

}  // namespace continuum
