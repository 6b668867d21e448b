#pragma once

#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// Whether a row holds a measurement of a channel: a number; for the channels of a quaternion four,
/// not all near zero.
bool IsMeasured(const Experiment& e, const Log& log, std::size_t channel, std::size_t row);

/// Simulated minus measured, per channel and row, in SI; NaN where nothing was measured, infinite
/// where something was and the simulation gives no number (it has diverged). The four channels of a
/// quaternion hold the three components of the rotation vector from the measured to the simulated
/// orientation [rad], in the measured frame, and zero.
std::vector<std::vector<double>> Residuals(const Experiment& e, const Log& log, const Trace& trace);

/// How far one channel of one log is off.
struct ChannelScore {
  std::string channel, unit;
  std::size_t rows = 0;  ///< compared
  double rmse = 0;       ///< [unit]
  double mae = 0;        ///< mean absolute error [unit]
  double nrmse = 0;      ///< rmse over the standard deviation of the measured values; constant: 0
  double fit = 0;        ///< 100 (1 − |error| / |measured − mean|) [%]
  double largest = 0;    ///< largest deviation [unit], signed
  double when = 0;       ///< its time [s]
};
std::vector<ChannelScore> ScoreLog(const Experiment& e, const Log& log, const Trace& trace);

/// "; mean absolute error averaged over logs and channels 0.0736 rad"; empty when the scores have
/// several units, or a log diverges.
std::string MeanAbsoluteErrorText(const std::vector<ChannelScore>& scores);

/// The unit in which errors of several channels are pooled: their own when they share one. Else
/// "std": each channel is divided by the standard deviation of its measured train rows (an
/// orientation by that of its rotation from the mean).
class Pool {
 public:
  explicit Pool(const Experiment& e);

  const std::string& unit() const { return unit_; }
  /// SI per pooled unit of a channel.
  double scale(std::size_t channel) const { return scale_[channel]; }
  /// Whether the channel counts (weight above 0).
  bool counts(std::size_t channel) const { return counts_[channel]; }

  /// Adds one log's residuals; Rms is over all samples added since Clear.
  struct Sum {
    double squares = 0;
    std::size_t count = 0;
    double Rms() const;
  };
  void Add(const std::vector<std::vector<double>>& residuals, Sum& sum) const;

 private:
  std::string unit_;
  std::vector<double> scale_;
  std::vector<bool> counts_;
};

}  // namespace continuum
