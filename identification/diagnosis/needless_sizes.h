#pragma once

#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// Takes those of the sizes of a complete fit out that the data do not need, as one axis of a tilt
/// or of a force: one after the other the one that costs least, as long as the squares do not rise
/// by what a parameter has to earn. Only sizes in one unit, and none of a law with a Coulomb level:
/// without its excess that is another law. Returns whether any was taken out.
bool DropNeedlessSizes(const CandidateFitter& fitter, CandidateResult& candidate);

/// The same for sizes of the cause beside which it was fitted (all of its hypothesis.given), which
/// that cause loses as well.
bool DropNeedlessSizes(const CandidateFitter& fitter, CandidateResult& candidate,
                       Hypothesis& beside);

/// How many numbers of its own a complete fit has that change these logs, each in its own way: of a
/// force on a slide one of its three, of a tilt one where nothing tells its axes apart. Only these
/// have to be paid for. All of them where the fit is not complete.
std::size_t NumbersThatShow(const CandidateResult& candidate);

}  // namespace continuum
