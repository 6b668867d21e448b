#pragma once

#include <optional>

#include "identification/diagnosis/cause_pairs.h"

namespace continuum {

/// Calls a model adequate whose lengths and masses do all that shows, off by no more than they may
/// be (lengths_and_masses.h). They are asked where a number of the model that is a little off does
/// nearly as well as the best of the search, or two of them are the best pair. Whether they did it.
bool AllowForNumbers(const CandidateFitter& fitter, const CandidateSearch& search,
                     const std::optional<Pair>& pair, Diagnosis& d);

/// Whether lengths and masses that are a little off move the main size of a cause by as much as it
/// is (Uncertainty::by_numbers).
bool NumbersMayDoAsMuch(const CandidateResult& candidate);

/// AllowForLengthsAndMasses in the intervals of all that is named, and of its siblings.
void AllowInIntervals(const CandidateFitter& fitter, const DiagnosisOptions& options, Diagnosis& d);

/// After that: a cause that only corrects a number, by no more than lengths and masses may, is not
/// named alone where they explain as much. No one knows which number is off. Where it takes hardly
/// anything off the error, nothing is missing.
void DoubtByNumbers(const CandidateFitter& fitter, Diagnosis& d);

}  // namespace continuum
