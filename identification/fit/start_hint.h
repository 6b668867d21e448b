#pragma once

#include <string>
#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// Whether trials that begin as measured (start: measured) begin elsewhere, by what follows: one
/// sentence where a few steps of a fit from x that estimates the starts too take a tenth off the
/// cost, and more than noise would; else nothing. Models of so many joints that this takes long are
/// not looked at.
std::string StartHint(const Problem& problem, const Problem::Vector& x,
                      const std::vector<bool>& use);

}  // namespace continuum
