#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// Makes one name of a verdict whose names are one effect at several places: the data do not
/// distinguish the places.
void MergePlaces(Diagnosis& diagnosis);

/// Whether each cause of a pair is one; what corrects the model may be several things. others: so
/// many are named beside the first.
bool IsOnePair(const Partner& first, std::size_t others);

}  // namespace continuum
