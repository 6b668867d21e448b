#pragma once

#include <string>

namespace continuum {

/// Another value for an attribute of the model.
///
/// target: "joint:bend*", "actuator:servo", "option", "plugin:NAME" (an effect's parameter).
/// attribute: its MJCF name, with an index where it has several ("gear[0]"), or "effect:NAME" for a
/// native effect of the list, whose parameter is the value.
struct Change {
  enum class Operation { kSet, kScale, kAdd };
  std::string target, attribute;
  double value = 0;
  Operation operation = Operation::kSet;
  bool operator==(const Change&) const = default;
};

}  // namespace continuum
