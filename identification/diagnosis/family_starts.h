#pragma once

#include <optional>
#include <vector>

#include "identification/diagnosis/result.h"

namespace continuum {

/// Whether a law contains another one by what their cards say: a friction whose level may be
/// constant, and one whose level is, at the same place.
bool ContainsByCard(const Hypothesis& rich, const Hypothesis& plain);

/// Whether a law is a plainer one of another one's family, or that one contains it, at the same
/// place.
bool IsPlainerThan(const Hypothesis& plain, const Hypothesis& rich);
/// Whether a family has a plainer law than this one.
bool IsRich(const Hypothesis& hypothesis);

/// Where the fit of a richer law of a family may begin once the plain one has a fit: with the model
/// as that fit left it, and with its size. A Stribeck friction begins as the Coulomb friction that
/// was found, without an excess, and with the excess of its starts at every speed: so that it is
/// never behind the law that it contains, wherever joints stick and slip. Nothing where the two
/// laws share no size.
std::vector<Problem::Vector> StartsFromPlain(const CandidateResult& plain, const Hypothesis& rich);

/// Where the fit of the plain law may begin once a richer one has a fit: with the model as that
/// left it, and with its values of the same name, or of the unit of the plain one's size. Nothing
/// where they share none.
std::optional<Problem::Vector> StartFromRich(const CandidateResult& rich, const Hypothesis& plain);

}  // namespace continuum
