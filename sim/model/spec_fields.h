#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <mujoco/mujoco.h>

namespace continuum {

/// The numbers behind an attribute.
struct Field {
  double* data;
  int size;
};
using Fields = std::map<std::string, Field, std::less<>>;

/// Every double of an element's specification under the name of its member, from MuJoCo's own lists
/// of members; in the units of the specification.
Fields FieldsOf(mjsElement* element);

/// "gear[2]" → ("gear", 2); without an index 0, with a wrong one −1.
std::pair<std::string, int> SplitIndex(std::string_view attribute);

/// Kinds of elements that have attributes, by the name that targets use ("joint").
const std::map<std::string, mjtObj, std::less<>>& ElementKinds();
/// The name of a kind; "element" for others.
std::string KindName(mjtObj kind);

}  // namespace continuum
