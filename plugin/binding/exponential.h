#pragma once

#include <span>

namespace continuum {

/// y = e^x of numbers that are not below 0: where all are small by the series, which is then good
/// to 1e-16.
void Exponential(std::span<const double> x, std::span<double> y);

}  // namespace continuum
