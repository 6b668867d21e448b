#pragma once

#include <string>
#include <string_view>

namespace continuum {

/// Throws Error (file:line) where the MJCF of a file gives a plugin's key an empty value. MuJoCo
/// keeps no trace of it: the plugin would read the key as absent.
void RefuseEmptyConfig(std::string_view xml, const std::string& file);

}  // namespace continuum
