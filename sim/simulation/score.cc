#include "sim/simulation/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/core.h>

namespace continuum {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// The rotation vector that turns the measured orientation into the simulated one, and zero.
std::array<double, 4> Turn(const Log& log, const Trace& trace, std::size_t first, std::size_t row) {
  double simulated[4], measured[4];
  std::array<double, 4> turn{};
  for (int c = 0; c < 4; ++c) {
    simulated[c] = trace.channel[first + c][row];
    measured[c] = log.measured[first + c][row];
  }
  mju_normalize4(measured);
  mju_subQuat(turn.data(), simulated, measured);
  return turn;
}

// A measured row without a simulated number must not look like one without a measurement.
double OrDiverged(double residual) {
  return std::isfinite(residual) ? residual : std::numeric_limits<double>::infinity();
}

struct Moments {
  double mean = 0, std = 0;
};
Moments MomentsOf(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  std::size_t n = 0;
  for (const double v : values) {
    if (!std::isnan(v)) sum += v, ++n;
  }
  const double mean = n ? sum / static_cast<double>(n) : 0;
  for (const double v : values) {
    if (!std::isnan(v)) squares += (v - mean) * (v - mean);
  }
  const double std = n ? std::sqrt(squares / static_cast<double>(n)) : 0;
  return {mean, std > 1e-12 * std::abs(mean) ? std : 0};  // else rounding of equal values
}

// Of the measured train rows of a channel.
double TrainStd(const Experiment& e, std::size_t channel) {
  std::vector<double> train;
  for (const Log& log : e.logs) {
    const auto& measured = log.measured[channel];
    if (log.train) train.insert(train.end(), measured.begin(), measured.end());
  }
  return MomentsOf(train).std;
}

// The same of an orientation [rad], for each component of the turn from the mean one.
double TurnStd(const Experiment& e, std::size_t first) {
  std::vector<std::array<double, 4>> train;
  double mean[4] = {};
  for (const Log& log : e.logs) {
    for (std::size_t row = 0; log.train && row < log.rows(); ++row) {
      if (!IsMeasured(e, log, first, row)) continue;
      auto& q = train.emplace_back();
      for (int i = 0; i < 4; ++i) q[i] = log.measured[first + i][row];
      mju_normalize4(q.data());
      mju_addToScl(mean, q.data(), mju_dot(mean, q.data(), 4) < 0 ? -1 : 1, 4);
    }
  }
  mju_normalize4(mean);
  double squares = 0;
  for (const auto& q : train) {
    double turn[3];
    mju_subQuat(turn, q.data(), mean);
    squares += mju_dot3(turn, turn);
  }
  return train.empty() ? 0 : std::sqrt(squares / (3 * static_cast<double>(train.size())));
}

}  // namespace

bool IsMeasured(const Experiment& e, const Log& log, std::size_t channel, std::size_t row) {
  const auto& c = e.channels[channel];
  if (!e.outputs[c.output].quaternion()) return !std::isnan(log.measured[channel][row]);
  double squares = 0;
  for (int i = 0; i < 4; ++i) {
    const double q = log.measured[channel - c.component + i][row];
    squares += q * q;
  }
  return squares > 0.25;  // false for NaN too; loggers write four zeros for what they lost
}

std::vector<std::vector<double>> Residuals(const Experiment& e, const Log& log,
                                           const Trace& trace) {
  std::vector<std::vector<double>> out(e.channels.size(),
                                       std::vector<double>(log.rows(), kMissing));
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const std::size_t component = e.channels[c].component;
    const bool turn = e.outputs[e.channels[c].output].quaternion();
    for (std::size_t row = 0; row < log.rows(); ++row) {
      if (!IsMeasured(e, log, c, row)) continue;
      out[c][row] = OrDiverged(turn ? Turn(log, trace, c - component, row)[component]
                                    : trace.channel[c][row] - log.measured[c][row]);
    }
  }
  return out;
}

std::vector<ChannelScore> ScoreLog(const Experiment& e, const Log& log, const Trace& trace) {
  const auto residuals = Residuals(e, log, trace);
  std::vector<ChannelScore> scores;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& channel = e.channels[c];
    ChannelScore s{channel.name, channel.unit};
    double squares = 0, absolute = 0;
    for (std::size_t row = 0; row < log.rows(); ++row) {
      if (std::isnan(residuals[c][row])) continue;
      const double error = residuals[c][row] / channel.factor;
      ++s.rows;
      squares += error * error;
      absolute += std::abs(error);
      if (!(std::abs(error) <= std::abs(s.largest))) s.largest = error, s.when = log.time[row];
    }
    const double n = static_cast<double>(std::max<std::size_t>(s.rows, 1));
    const double std = MomentsOf(log.measured[c]).std / channel.factor;
    s.rmse = std::sqrt(squares / n);
    s.mae = absolute / n;
    s.nrmse = std > 0 ? s.rmse / std : 0;
    s.fit = std > 0 ? 100 * (1 - s.nrmse) : 0;
    scores.push_back(s);
  }
  return scores;
}

std::string MeanAbsoluteErrorText(const std::vector<ChannelScore>& scores) {
  double sum = 0;
  for (const ChannelScore& s : scores) {
    if (s.unit != scores.front().unit || !std::isfinite(s.mae)) return "";
    sum += s.mae;
  }
  if (scores.empty()) return "";
  return fmt::format("; mean absolute error averaged over logs and channels {:.4g} {}",
                     sum / static_cast<double>(scores.size()), scores.front().unit);
}

Pool::Pool(const Experiment& e) {
  std::string unit;
  bool one = true;
  for (const auto& channel : e.channels) {
    // A rotation has three numbers, its quaternion four channels.
    const bool fourth = e.outputs[channel.output].quaternion() && channel.component == 3;
    counts_.push_back(e.outputs[channel.output].weight > 0 && !fourth);
    if (!counts_.back()) continue;
    one &= unit.empty() || unit == channel.unit;
    unit = channel.unit;
  }
  unit_ = one ? unit : "std";
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    scale_.push_back(e.channels[c].factor);
    if (one) continue;
    const double std = e.outputs[e.channels[c].output].quaternion()
                           ? TurnStd(e, c - e.channels[c].component)
                           : TrainStd(e, c);
    if (std > 0) scale_.back() = std;
  }
}

double Pool::Sum::Rms() const {
  return count ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

void Pool::Add(const std::vector<std::vector<double>>& residuals, Sum& sum) const {
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    if (!counts_[c]) continue;
    for (const double r : residuals[c]) {
      if (std::isnan(r)) continue;
      sum.squares += r * r / (scale_[c] * scale_[c]);
      ++sum.count;
    }
  }
}

}  // namespace continuum
