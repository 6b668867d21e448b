#pragma once

#include <string>

namespace continuum {

/// Another value for an attribute of the model.
///
/// target: "joint:bend*", "actuator:servo", "option" or "world", "plugin:NAME" (an effect's
/// parameter).
/// attribute: its MJCF name, with an index where it has several ("gear[0]"), or a parameter of a
/// native effect of the list: "effect:NAME.PARAM", "effect:NAME" for its first. All changes of one
/// effect at one target act together; parameters that are not among them stay at their null.
struct Change {
  enum class Operation { kSet, kScale, kAdd };
  std::string target, attribute;
  double value = 0;
  Operation operation = Operation::kSet;
  bool operator==(const Change&) const = default;
};

/// What becomes of a value.
inline double Changed(double old, const Change& change) {
  switch (change.operation) {
    case Change::Operation::kScale:
      return old * change.value;
    case Change::Operation::kAdd:
      return old + change.value;
    default:
      return change.value;
  }
}

}  // namespace continuum
