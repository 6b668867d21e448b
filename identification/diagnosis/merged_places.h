#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// Makes one name of a verdict whose names are one effect at several places: the data do not
/// distinguish the places.
void MergePlaces(Diagnosis& diagnosis);

}  // namespace continuum
