#pragma once

#include <vector>

#include "identification/candidates/object_sets.h"
#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// The length and the mass of each body by itself, as candidates; none of those that the experiment
/// fits.
std::vector<Hypothesis> NumbersOfBodies(const CandidateContext& context);

/// What lengths and masses that are a little off explain.
struct ByLengthsAndMasses {
  double squares = 0;
  double off = 0;  ///< the largest share of itself by which one of them is off
  Eigen::Index numbers = 0;
};

/// What lengths and masses that are a little off may explain of the residual r of a fitted cause,
///
///   max_a |z|² − |z + C a|² − |a|²,                                        (1)
///
/// [squares], to first order: z = M r whitened, less what the fitted parameters explain. A column
/// of C is what link_known of the length or of the mass of one body does to z, a its size in units
/// of that, as likely a priori as a standard normal number. Nothing where the fit is not complete
/// or there is no time for it. system, given: what was fitted, and free parameters of its causes.
ByLengthsAndMasses ExplainedByLengthsAndMasses(const CandidateFitter& fitter, const Sizes& sizes,
                                               const ModelSpec& system,
                                               const std::vector<Parameter>& given,
                                               const Fitted& fitted);

/// What those numbers do to the parameters of a complete fit, to first order, with the columns of C
/// not projected and P = (JᵀJ)⁻¹: by themselves they move each parameter by
///
///   √Σ_k (P JᵀC)_ik²                                                                      (2)
///
/// (Uncertainty::by_numbers). Where the model leaves more than noise, part of which may be theirs,
/// intervals are extended to those of a fit whose numbers are free as well, at a time step of zero:
///
///   min over d, a of |r + J d + C a|² + |a|²,   x + d ± t s √(N⁻¹),                       (3)
///
/// N: the matrix of its normal equations; s: the standard error of the fit over what white noise
/// would make of it, at least 1.
void AllowForLengthsAndMasses(const CandidateFitter& fitter, const Sizes& sizes,
                              const ModelSpec& system, const std::vector<Parameter>& given,
                              bool more_is_left, Fitted& fitted);

}  // namespace continuum
