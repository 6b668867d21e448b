#pragma once

#include <string>

namespace continuum {

/// The name of this machine.
std::string HostName();

}  // namespace continuum
