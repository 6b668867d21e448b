#pragma once

#include <span>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// A free parameter of a candidate. Its bounds and its initial value follow from its unit and the
/// typical sizes of the experiment. Throws Error for a unit that has no size.
Parameter CandidateParameter(const Param& p, Place place, const Sizes& sizes,
                             const std::string& target, const std::string& attribute,
                             Change::Operation operation);

/// The same for a law of a cable's contacts (SizeAlongCable).
Parameter CableParameter(const Param& p, const Sizes& sizes, const std::string& target);

/// The points from which a search begins, each the values of all parameters of a candidate. The
/// first has the initial values. In the others one parameter differs: a nuisance (null: NaN) or a
/// frequency is another of its grid (GridOf), and what acts on an actuator has the other sign.
/// Where inputs rest at a bound the two signs are no mirror images. Values of one parameter under
/// several conditions are alike. law: the parameters of the effect's card.
std::vector<std::vector<double>> SearchStarts(const Hypothesis& hypothesis,
                                              const std::vector<Param>& law, const Sizes& sizes);

/// Makes ten times as wide every range at whose end a fit has put the value, within what the law
/// allows. Returns whether there were any. Three kinds stay: parameters that the law does not know;
/// factors (null: 1), as a body with next to no mass would become a load; and laws with a nuisance
/// (null: not finite), which at sizes without limit take the shape of others.
bool Widen(std::vector<Parameter>& extra, const std::vector<double>& null,
           const std::vector<Param>& law, std::span<const double> values);

}  // namespace continuum
