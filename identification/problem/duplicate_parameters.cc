#include "identification/problem/duplicate_parameters.h"

#include <string>

#include "error.h"
#include "sim/experiment/measurement_model.h"

namespace continuum {
namespace {

std::vector<std::string> TargetsOf(const Parameter& p, const ModelSpec& system) {
  return IsMeasurement(p.target, p.attribute) ? std::vector{p.target} : system.Named(p.target);
}

// "gear[0]" and "gear" are one.
std::string Unindexed(const std::string& attribute) {
  return attribute.ends_with("[0]") ? attribute.substr(0, attribute.size() - 3) : attribute;
}

bool AreDuplicates(const Parameter& a, const Parameter& b, const ModelSpec& system) {
  return !a.frozen && !b.frozen && a.operation == b.operation &&
         Unindexed(a.attribute) == Unindexed(b.attribute) &&
         TargetsOf(a, system) == TargetsOf(b, system);
}

}  // namespace

void RefuseDuplicates(const std::vector<Parameter>& parameters, const ModelSpec& system) {
  for (std::size_t b = 0; b < parameters.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const Parameter &one = parameters[a], &two = parameters[b];
      if (!AreDuplicates(one, two, system)) continue;
      throw Error::Input(two.where + ": parameter '" + two.name + "'",
                         "another target, attribute or operation than that of '" + one.name +
                             "' (" + one.where + ")",
                         "the same: " + two.target + ", " + two.attribute);
    }
  }
}

}  // namespace continuum
