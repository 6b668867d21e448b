#pragma once

#include <string>
#include <vector>

#include "identification/diagnosis/result.h"

namespace continuum {

/// Effects of the list that there was no time to look at, at any place, in the order of the list.
std::vector<std::string> UnseenEffects(const Diagnosis& diagnosis);

/// Whether so many effects were not looked at that a name may be any of them.
bool TooManyUnseen(const Diagnosis& diagnosis);

/// Then a name becomes a set: the time was over before most of the list had its turn.
void WeighUnseen(Diagnosis& diagnosis);

}  // namespace continuum
