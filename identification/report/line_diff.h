#pragma once

#include <string>

namespace continuum {

/// Lines that differ between two texts, with "-" and "+" in front, as a minimal line diff.
std::string LineDiff(const std::string& before, const std::string& after);

}  // namespace continuum
