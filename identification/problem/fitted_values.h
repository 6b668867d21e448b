#pragma once

#include <filesystem>

#include "identification/problem/problem.h"

namespace continuum {

/// Reads the values that a fit.json has for the parameters of a problem. Throws Error (kInput; file
/// and parameter) when it is none, lacks one, or has one beyond its bounds.
Problem::Vector FittedValues(const std::filesystem::path& fit, const Problem& problem);

}  // namespace continuum
