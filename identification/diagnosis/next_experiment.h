#pragma once

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// Simulates the chosen candidate under several changes of a train log's inputs, and lets every
/// rival of the set refit that to first order, and the other way round. separation: of the input
/// that parts the closest rival best, what no refit takes away, in units of twice the
/// log-likelihood where the noise is known (else of the mean square of what remains, for want of
/// better):
///   λ = |M W (y_rival − y_chosen)|²
/// Below about 15 no change of the inputs parts them.
NextExperiment ProposeNext(const CandidateFitter& trials, const Diagnosis& diagnosis);

/// Its inputs from t = 0, in the columns and units of the experiment.
std::string NextCsv(const Experiment& experiment, const Log& next);

}  // namespace continuum
