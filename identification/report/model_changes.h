#pragma once

#include <string>
#include <vector>

#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// What the extended model and its experiment have that the model before has not, one line each.
///
/// "adds payload at body tip: mass 0.0592 kg (95 %: 0.0578 … 0.0605)" for a cause, "stiffness of
/// joint bend*: 1.24 → 1.25 N m/rad" for a value that was fitted. Values at a bound are marked.
/// Values that stay as they are to three digits are left out.
std::vector<std::string> ChangesInWords(const Diagnosis& diagnosis, const ExtensionRun& run);

/// Those of them that are values which a model without the cause has too.
std::vector<std::string> FittedValuesInWords(const Diagnosis& diagnosis, const ExtensionRun& run);

/// The parameters of one cause: "mass 0.0592 kg (95 %: 0.0578 … 0.0605)". begin: where its values
/// begin in the fit.
std::string ValuesInWords(const Hypothesis& hypothesis, const Fitted& fitted, Eigen::Index begin);

/// The unit of one of the free parameters of an effect; empty for a pure number.
std::string UnitOfExtra(const Hypothesis& hypothesis, std::size_t parameter);

/// Parameters that the fit of the extended model left at a bound, each with its value and the
/// bound.
std::vector<std::string> AtBoundInWords(const Diagnosis& diagnosis, const ExtensionRun& run);

}  // namespace continuum
