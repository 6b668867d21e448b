#pragma once

#include <string>
#include <vector>

#include "identification/result/noise.h"
#include "sim/numerics/portable_random.h"
#include "sim/simulation/score.h"

namespace continuum {

/// Whether a fit leaves so many times the noise, where that is known, that it lacks something or
/// ended in a wrong place.
inline bool IsFarOver(const Noise& noise, double rms) {
  constexpr double kTimes = 5;
  return noise.rms > 0 && rms > kTimes * noise.rms;
}

/// Whether a fit leaves little more than the noise, where that is known.
inline bool IsNear(const Noise& noise, double rms) {
  constexpr double kTimes = 1.5;
  return noise.rms > 0 && rms <= kTimes * noise.rms;
}

/// From replicates (logs of one trial and condition with the same inputs and rows, or nearly so:
/// then on one grid, the shift in time between them taken out): what each differs from their mean,
/// in which model error cancels. Else from sigma where every output gives
/// it. Else from third differences of the measured rows (smooth motion cancels), a lower bound that
/// sees only white noise; rows of quasi-static logs are poses of their own, whose differences say
/// nothing of it.
Noise NoiseOf(const Experiment& experiment);

/// The noise of a channel whose values are rounded to steps larger than its noise, from values that
/// a model gives [log][row]: rounding errors of a slow motion are slow, and differences of
/// replicates do not show them. Repeats exactly.
ChannelNoise RoundingNoise(const ChannelNoise& noise,
                           const std::vector<std::vector<double>>& values);

/// Whether a channel's values are rounded to steps larger than its noise.
bool Rounded(const ChannelNoise& noise);
/// Where the values that a model gives lie between two steps of a sensor: as good as random.
double Phase(const ChannelNoise& noise, Random64& random);
/// One draw of a rounded channel's noise in one log; phase: the same in all logs of a sensor, so
/// that repetitions of one motion share most of their errors.
std::vector<double> RoundingErrors(const ChannelNoise& noise, std::vector<double> values,
                                   double phase, Random64& random);

/// One draw of a channel's noise over so many rows, as its model says.
std::vector<double> NoiseDraw(const ChannelNoise& noise, std::size_t rows, Random64& random);

/// Logs that repeat each other, one group per motion; logs without a replicate are in none.
std::vector<std::vector<std::size_t>> ReplicateGroups(const Experiment& experiment);

/// The model of a channel's noise from samples of it, each of one log and with mean error (NaN:
/// not measured).
ChannelNoise NoiseFrom(const std::vector<std::vector<double>>& samples);

}  // namespace continuum
