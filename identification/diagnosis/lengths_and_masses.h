#pragma once

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// What lengths and masses that are a little off may explain of the residual r of a fitted cause,
///
///   max_a |z|² − |z + C a|² − |a|²,                                        (1)
///
/// [squares], to first order: z = M r whitened, less what the fitted parameters explain. A column
/// of C is what link_known of the length or of the mass of one body does to z, a its size in units
/// of that, as likely a priori as a standard normal number. 0 where the cause has no complete fit
/// or there is no time for it.
double ExplainedByLengthsAndMasses(const CandidateFitter& fitter, const Sizes& sizes,
                                   const CandidateResult& cause);

}  // namespace continuum
