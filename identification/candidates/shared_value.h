#pragma once

#include <span>
#include <string_view>

#include "sim/model/change.h"

namespace continuum {

/// How one number changes a value that several objects have already, so that the effect is absent
/// at `null`: it is the value where all have the same, a factor of them where all have the same
/// sign, else what is added to each.
struct SharedValue {
  double null;
  Change::Operation operation;
  std::string_view suffix;  ///< of the parameter's name: "", "_factor" or "_added"
};

/// values: of each object, at least one.
SharedValue SharedValueOf(std::span<const double> values);

}  // namespace continuum
