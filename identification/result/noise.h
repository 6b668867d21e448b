#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace continuum {

/// The measurement noise of one channel, in SI:   y = f + o + e,   e_k = Σ a_i e_{k−i} + w_k
///
/// o: one offset per log, normal with standard deviation offset; w: white, normal.
struct ChannelNoise {
  std::vector<double> ar;  ///< a_1 …, empty: white
  double innovation = 0;   ///< standard deviation of w
  double offset = 0;
  double rms = 0;      ///< standard deviation of e
  double quantum = 0;  ///< step of the measured values; 0: none to be seen
  double before = 0;   ///< standard deviation of what was added before the values were rounded
};

/// How large the measurement noise is, and how one knows.
struct Noise {
  double rms = 0;             ///< pooled unit; 0: not known
  double step = 0;            ///< what the model's own time step adds (h against h/4), pooled unit
  std::string source;         ///< "replicates", "sigma", "differences", "not known"
  std::size_t pairs = 0;      ///< of replicates
  std::size_t resampled = 0;  ///< logs that were brought onto the rows of their replicate
  std::vector<ChannelNoise> channel;  ///< [channel]; empty: not known

  bool known() const { return !channel.empty(); }
  /// The error that a model without a fault has.
  double floor() const { return std::hypot(rms, step); }
};

}  // namespace continuum
