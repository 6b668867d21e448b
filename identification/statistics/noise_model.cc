#include "identification/statistics/noise_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>
#include <boost/math/distributions/chi_squared.hpp>

#include "identification/statistics/one_grid.h"
#include "sim/experiment/replicates.h"
#include "sim/numerics/decompositions.h"

namespace continuum {
namespace {

constexpr int kHighestOrder = 4;

// [log] by how much each is later than the first of its group [s]; none where it has the same rows.
using Shifts = std::vector<std::optional<double>>;

Shifts ShiftsOf(const Experiment& e, const std::vector<std::vector<std::size_t>>& groups) {
  Shifts shifts(e.logs.size());
  for (const auto& group : groups) {
    const Log& first = e.logs[group[0]];
    for (const std::size_t l : group) {
      if (!AreReplicates(first, e.logs[l])) shifts[l] = ShiftOf(e.logs[l], first);
    }
  }
  return shifts;
}

// A channel of logs of one motion on the grid of the first.
std::vector<OnGrid> OnOneGrid(const Experiment& e, const std::vector<std::size_t>& group,
                              const Shifts& shifts, std::size_t channel) {
  std::vector<OnGrid> all;
  for (const std::size_t l : group) {
    const Log& log = e.logs[l];
    if (shifts[l]) {
      all.push_back(Resampled(log, channel, e.logs[group[0]], *shifts[l]));
    } else {
      all.push_back({log.measured[channel], std::vector<double>(log.rows(), 1)});
    }
  }
  return all;
}

// What each replicate of one channel differs from their mean, at the size of one log's noise.
std::vector<std::vector<double>> Deviations(const Experiment& e,
                                            const std::vector<std::size_t>& group,
                                            const Shifts& shifts, std::size_t channel) {
  const std::vector<OnGrid> logs = OnOneGrid(e, group, shifts, channel);
  const std::size_t rows = e.logs[group[0]].rows(), n = group.size();
  std::vector<std::vector<double>> out(n, std::vector<double>(rows));
  const double share = 1 / static_cast<double>(n);
  for (std::size_t k = 0; k < rows; ++k) {
    double mean = 0, variance = 0;  // NaN as soon as one is missing; of the mean
    for (const OnGrid& log : logs)
      mean += share * log.value[k], variance += share * share * log.variance[k];
    for (std::size_t i = 0; i < n; ++i) {
      const double own = (1 - 2 * share) * logs[i].variance[k] + variance;
      out[i][k] = (logs[i].value[k] - mean) / std::sqrt(own);
    }
  }
  if (n == 2) out.pop_back();  // the other one mirrored
  return out;
}

double MeanOf(const std::vector<double>& y) {
  double sum = 0, n = 0;
  for (const double v : y) {
    if (!std::isnan(v)) sum += v, n += 1;
  }
  return n > 0 ? sum / n : 0;
}

// Σ_k y_k y_{k+lag} / n over all series about their means, where both were measured.
std::vector<double> Autocovariance(const std::vector<std::vector<double>>& series, double& count) {
  std::vector<double> c(kHighestOrder + 1, 0);
  count = 0;
  for (const auto& y : series) {
    const double mean = MeanOf(y);
    for (std::size_t lag = 0; lag < c.size(); ++lag) {
      for (std::size_t k = lag; k < y.size(); ++k) {
        if (std::isnan(y[k]) || std::isnan(y[k - lag])) continue;
        c[lag] += (y[k] - mean) * (y[k - lag] - mean);
        if (lag == 0) count += 1;
      }
    }
  }
  for (double& v : c) v /= std::max(1.0, count - static_cast<double>(series.size()));
  return c;
}

// The smallest step between measured values, when all of them are whole multiples of it.
double QuantumOf(const std::vector<const std::vector<double>*>& logs) {
  std::vector<double> values;
  std::size_t rows = 0;
  for (const auto* log : logs) {
    for (const double v : *log) {
      if (!std::isnan(v)) values.push_back(v);
    }
  }
  rows = values.size();
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 3 || 4 * values.size() > rows) return 0;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i) step = std::min(step, values[i] - values[i - 1]);
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double multiple = (values[i] - values[i - 1]) / step;
    if (std::abs(multiple - std::round(multiple)) > 0.01) return 0;
  }
  return step;
}

// A value between two steps is anywhere in ±q/2: as noise, and at rest as an offset.
void AddQuantum(ChannelNoise& noise, double quantum) {
  noise.quantum = quantum;
  noise.before = noise.rms;
  const double error = quantum / std::sqrt(12.0);
  if (noise.rms >= quantum / 2) return;  // the noise carries the values over the steps
  noise.offset = std::max(noise.offset, error);
  if (noise.rms >= error) return;
  noise.ar.clear();
  noise.innovation = noise.rms = error;
}

}  // namespace

std::vector<std::vector<std::size_t>> ReplicateGroups(const Experiment& e) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return AreNearReplicates(e.logs[group[0]], e.logs[l]);
    });
    if (same != groups.end()) {
      same->push_back(l);
    } else {
      groups.push_back({l});
    }
  }
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

// Yule-Walker, the order by Schwarz's criterion. Offsets: what the means of the samples scatter
// more than e alone makes them.
ChannelNoise NoiseFrom(const std::vector<std::vector<double>>& samples) {
  double count = 0;
  const auto c = Autocovariance(samples, count);
  ChannelNoise noise;
  if (!(c[0] > 0) || count < 20) {
    noise.innovation = noise.rms = std::sqrt(std::max(0.0, c[0]));
    return noise;
  }
  double best = count * std::log(c[0]), variance = c[0];
  for (int p = 1; p <= kHighestOrder; ++p) {
    Eigen::MatrixXd R(p, p);
    Eigen::VectorXd r(p);
    for (int i = 0; i < p; ++i) {
      r[i] = c[i + 1];
      for (int j = 0; j < p; ++j) R(i, j) = c[std::abs(i - j)];
    }
    const Eigen::VectorXd a = R.ldlt().solve(r);
    const double left = c[0] - a.dot(r);
    if (!(left > 0)) break;
    const double score = count * std::log(left) + p * std::log(count);
    if (score >= best) continue;
    best = score, variance = left;
    noise.ar.assign(a.begin(), a.end());
  }
  noise.innovation = std::sqrt(variance);
  noise.rms = std::sqrt(c[0]);
  double gain = 1;
  for (const double a : noise.ar) gain -= a;
  double scatter = 0, expected = 0;
  for (const auto& y : samples) {
    const double mean = MeanOf(y), n = static_cast<double>(y.size());
    const double of_mean = variance / (gain * gain) / n;
    scatter += mean * mean / of_mean;
    expected += of_mean / static_cast<double>(samples.size());
  }
  const double s = static_cast<double>(samples.size());
  if (scatter > boost::math::quantile(boost::math::chi_squared(s), 0.95)) {
    // A few offsets may all be small by chance: take the variance at the upper end of its 90 %.
    const double few = s / boost::math::quantile(boost::math::chi_squared(s), 0.1);
    noise.offset = std::sqrt(few * (scatter / s - 1) * expected);
  }
  return noise;
}

bool Rounded(const ChannelNoise& noise) {
  return noise.quantum > 0 && noise.before < noise.quantum / 2;
}

double Phase(const ChannelNoise& noise, Random64& random) {
  return noise.quantum * random.Uniform();
}

std::vector<double> RoundingErrors(const ChannelNoise& noise, std::vector<double> values,
                                   double phase, Random64& random) {
  random.BeginPair();
  for (double& y : values) {
    const double noisy = y + phase + noise.before * random.Normal();
    y = noise.quantum * std::round(noisy / noise.quantum) - y - phase;
  }
  return values;
}

std::vector<double> NoiseDraw(const ChannelNoise& noise, std::size_t rows, Random64& random) {
  random.BeginPair();
  const double offset = noise.offset * random.Normal();
  std::vector<double> e;
  for (std::size_t k = 0; k < rows; ++k) {
    const bool begun = k >= noise.ar.size();  // as the whitening begins
    double now = (begun ? noise.innovation : noise.rms) * random.Normal();
    for (std::size_t i = 0; begun && i < noise.ar.size(); ++i) now += noise.ar[i] * e[k - 1 - i];
    e.push_back(now);
  }
  for (double& value : e) value += offset;
  return e;
}

ChannelNoise RoundingNoise(const ChannelNoise& noise,
                           const std::vector<std::vector<double>>& values) {
  if (!Rounded(noise)) return noise;
  Random64 random(1);
  std::vector<std::vector<double>> errors;
  for (const auto& log : values)
    errors.push_back(RoundingErrors(noise, log, Phase(noise, random), random));
  ChannelNoise out = NoiseFrom(errors);
  out.quantum = noise.quantum, out.before = noise.before;
  return out;
}

namespace {

bool HasSigmas(const Experiment& e, const Pool& pool) {
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    if (pool.counts(c) && !(e.outputs[e.channels[c].output].sigma > 0)) return false;
  }
  return true;
}

// Third differences, of the size of white noise.
std::vector<double> ThirdDifferences(const std::vector<double>& y) {
  std::vector<double> d;
  for (std::size_t k = 3; k < y.size(); ++k)
    d.push_back((y[k] - 3 * y[k - 1] + 3 * y[k - 2] - y[k - 3]) / std::sqrt(20.0));
  return d;
}

double NoiseByDifferences(const Experiment& e, const Pool& pool) {
  Pool::Sum sum;
  for (const Log& log : e.logs) {
    auto third = log.measured;
    for (auto& y : third) {
      if (y.size() >= 4) y = ThirdDifferences(y);
    }
    pool.Add(third, sum);
  }
  return sum.Rms();
}

// groups: of replicates; empty: by sigma.
ChannelNoise NoiseOfChannel(const Experiment& e, std::size_t c,
                            const std::vector<std::vector<std::size_t>>& groups,
                            const Shifts& shifts) {
  ChannelNoise noise;
  noise.innovation = noise.rms = e.outputs[e.channels[c].output].sigma * e.channels[c].factor;
  if (!groups.empty()) {
    std::vector<std::vector<double>> samples;
    for (const auto& group : groups) {
      for (auto& sample : Deviations(e, group, shifts, c)) samples.push_back(std::move(sample));
    }
    noise = NoiseFrom(samples);
  }
  std::vector<const std::vector<double>*> measured;
  for (const Log& log : e.logs) measured.push_back(&log.measured[c]);
  if (const double quantum = QuantumOf(measured); quantum > 0) AddQuantum(noise, quantum);
  return noise;
}

}  // namespace

Noise NoiseOf(const Experiment& e) {
  const Pool pool(e);
  Noise noise;
  const auto groups = ReplicateGroups(e);
  for (const auto& group : groups) noise.pairs += group.size() * (group.size() - 1) / 2;
  const Shifts shifts = ShiftsOf(e, groups);
  noise.resampled = std::count_if(shifts.begin(), shifts.end(),
                                  [](const auto& shift) { return shift.has_value(); });
  noise.source = noise.pairs > 0      ? "replicates"
                 : HasSigmas(e, pool) ? "sigma"
                 : e.quasi_static     ? "not known"
                                      : "differences";
  if (noise.source == "differences") noise.rms = NoiseByDifferences(e, pool);
  if (noise.source != "replicates" && noise.source != "sigma") return noise;
  double squares = 0, counted = 0;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    noise.channel.push_back(NoiseOfChannel(e, c, groups, shifts));
    if (!pool.counts(c)) continue;
    const ChannelNoise& one = noise.channel.back();
    const double total = std::hypot(one.rms, one.offset) / pool.scale(c);
    squares += total * total, counted += 1;
  }
  noise.rms = counted > 0 ? std::sqrt(squares / counted) : 0;
  return noise;
}

}  // namespace continuum
