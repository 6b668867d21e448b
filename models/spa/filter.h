#pragma once

#include <vector>

namespace continuum {

/// Second-order Butterworth low-pass run forward and backward: no phase shift, gain
/// 1/(1 + (f/cutoff)⁴), one half at the cutoff [Hz]. period is the sample period [s],
/// 0 < cutoff < 1/(2 period). The signal is continued by point reflection at both ends.
/// Throws Error for a cutoff out of range or fewer than two samples.
std::vector<double> ZeroPhase(const std::vector<double>& signal, double cutoff, double period);

/// Central five-point differences [1/s], one-sided of lower order for the two samples at each end.
/// Throws Error for fewer than five samples.
std::vector<double> Differentiate(const std::vector<double>& signal, double period);

}  // namespace continuum
