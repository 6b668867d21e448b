#pragma once

#include <span>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// A parameter of a candidate, free within bounds and from an initial value that its unit and the
/// sizes of the experiment suggest.
Parameter FreeOne(const Param& p, Place place, const Sizes& sizes, const std::string& target,
                  const std::string& attribute, Change::Operation operation);

/// Values of a candidate's parameters to begin a search from: the initial ones; every nuisance
/// (null: NaN) at three sizes; and what acts on an actuator in the other direction too, because
/// where inputs rest at a bound the two directions are no mirror images.
std::vector<std::vector<double>> StartsOf(const std::vector<Parameter>& extra,
                                          const std::vector<double>& null);

/// Widens the ranges that a fit has put at an end, ten times but within what the law allows;
/// whether there were any. What the law does not know stays; so do factors (null: 1), as what has
/// next to no mass would become a load, and laws with a nuisance (null: not finite), which at sizes
/// without limit take the shape of others.
bool Widen(std::vector<Parameter>& extra, const std::vector<double>& null,
           const std::vector<Param>& law, std::span<const double> values);

}  // namespace continuum
