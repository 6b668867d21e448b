#pragma once

#include "identification/diagnosis/candidate_search.h"

namespace continuum {

/// Looks for a second cause beside the one that a diagnosis names by logs left out. One that passes
/// all rules of such a comparison beside the first is taken: the first becomes the partner, and the
/// candidates are those that were tried beside it. context: of the diagnosis.
void AddSecondByFolds(const SearchContext& context, Diagnosis& diagnosis);

}  // namespace continuum
