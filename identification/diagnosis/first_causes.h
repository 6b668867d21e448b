#pragma once

#include <vector>

#include "identification/diagnosis/criteria.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// The fitted candidates from which the search for two causes starts: of the first families the
/// best of each, or the plainest of it that explains nearly as much. A plain one that explains less
/// comes before it: beside another cause it may do as well. candidates: best first.
std::vector<const CandidateResult*> FirstCauses(const std::vector<CandidateResult>& candidates,
                                                const Criteria& criteria);

}  // namespace continuum
