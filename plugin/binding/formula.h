#pragma once

#include <string>
#include <vector>

#include "binding/config.h"
#include "binding/expression.h"
#include "effects/formula.h"
#include "error.h"

namespace continuum {

/// The formula of an instance, of its law's variables, then its parameters, then others.
template <FormulaLaw E>
Expression ReadFormula(const Config& config, const std::vector<std::string>& others) {
  const std::string key(E::kText);
  if (config.Get(key).empty()) throw Error::Input(config.Who(), "the key '" + key + "'", "none");
  std::vector<std::string> names(E::kVariables.begin(), E::kVariables.end());
  for (const Param& p : E::kParams) names.emplace_back(p.name);
  names.insert(names.end(), others.begin(), others.end());
  return {config.Get(key), names, config.Who() + ": " + key};
}

}  // namespace continuum
