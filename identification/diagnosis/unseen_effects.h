#pragma once

#include <string>
#include <vector>

#include "identification/diagnosis/result.h"

namespace continuum {

/// Effects of the list that there was no time to look at, at any place, in the order of the list.
std::vector<std::string> UnseenEffects(const Diagnosis& diagnosis);

/// Whether so many effects were not looked at that a name may be any of them.
bool TooManyUnseen(const Diagnosis& diagnosis);

/// Whether there was no time for the fit of any candidate.
bool NothingWasTried(const Diagnosis& diagnosis);

/// A name of which too many others were not seen becomes a set. "Adequate" without a known noise
/// says nothing where there was no time for too many effects, or where nothing was fitted and there
/// was no time for something: it becomes "unexplained".
void WeighUnseen(Diagnosis& diagnosis);

}  // namespace continuum
