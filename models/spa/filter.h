#pragma once

#include <vector>

namespace continuum {

/// Second-order Butterworth low-pass run forward and backward: no phase shift, gain
/// 1/(1 + (f/cutoff)⁴), one half at the cutoff [Hz]. period is the sample period [s],
/// 0 < cutoff < 1/(2 period). The signal is continued by point reflection at both ends.
/// Throws Error for a cutoff out of range or fewer than two samples.
std::vector<double> ZeroPhase(const std::vector<double>& signal, double cutoff, double period);

/// The mean over the odd number of samples around each that brings the gain
/// sin(π f W)/(n sin(π f period)), W = n period, nearest to one half at the cutoff [Hz] (n = 11 at
/// 60 Hz and 1 kHz); it is not positive everywhere. Ends and errors as above.
std::vector<double> MovingAverage(const std::vector<double>& signal, double cutoff, double period);

/// One of the two with its cutoff [Hz].
struct SpaFilter {
  enum class Kind { kButterworth, kAverage };
  double cutoff;
  Kind kind;

  SpaFilter(double cutoff, Kind kind = Kind::kButterworth) : cutoff(cutoff), kind(kind) {}
  std::vector<double> operator()(const std::vector<double>& signal, double period) const {
    return kind == Kind::kAverage ? MovingAverage(signal, cutoff, period)
                                  : ZeroPhase(signal, cutoff, period);
  }
};

/// Central five-point differences [1/s], one-sided of lower order for the two samples at each end.
/// Throws Error for fewer than five samples.
std::vector<double> Differentiate(const std::vector<double>& signal, double period);

}  // namespace continuum
