#pragma once

#include <string>

namespace continuum {

/// @throws Error (file:line) when a map of a YAML text has a key twice: a reader of the tree would
/// take one of the two values and say nothing. Throws YAML::Exception for what is no YAML.
void RefuseRepeatedKeys(const std::string& text, const std::string& name);

}  // namespace continuum
