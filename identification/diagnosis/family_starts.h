#pragma once

#include <vector>

#include "identification/diagnosis/result.h"

namespace continuum {

/// Whether a law is a plainer one of another one's family, at the same place.
bool IsPlainerThan(const Hypothesis& plain, const Hypothesis& rich);

/// Where the fit of a richer law of a family may begin once the plain one has a fit: with the model
/// as that fit left it, and with its size. A Stribeck friction begins as the Coulomb friction that
/// was found, without an excess, and with the excess of its starts at every speed: so that it is
/// never behind the law that it contains, wherever joints stick and slip. Nothing where the two
/// laws share no size.
std::vector<Problem::Vector> StartsFromPlain(const CandidateResult& plain, const Hypothesis& rich);

}  // namespace continuum
