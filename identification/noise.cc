#include "identification/noise.h"

#include <cmath>

namespace continuum {
namespace {

bool Replicates(const Log& a, const Log& b) {
  if (a.trial != b.trial || a.condition != b.condition || a.rows() != b.rows()) return false;
  for (std::size_t k = 0; k < a.rows(); ++k) {
    if (std::abs((a.time[k] - a.time[0]) - (b.time[k] - b.time[0])) > 1e-6) return false;
  }
  for (std::size_t i = 0; i < a.input.size(); ++i) {
    if (a.input[i] != b.input[i]) return false;
  }
  return true;
}

}  // namespace

Experiment WithStep(const Experiment& experiment, double step) {
  Experiment e = experiment;
  for (Log& log : e.logs) log.set.push_back({"option", "timestep", step});
  return e;
}

Noise NoiseOf(const Experiment& e) {
  const Pool pool(e);
  Noise noise;
  Pool::Sum sum;
  for (std::size_t a = 0; a < e.logs.size(); ++a) {
    for (std::size_t b = a + 1; b < e.logs.size(); ++b) {
      if (!Replicates(e.logs[a], e.logs[b])) continue;
      ++noise.pairs;
      auto difference = e.logs[a].measured;
      for (std::size_t c = 0; c < difference.size(); ++c) {
        for (std::size_t k = 0; k < difference[c].size(); ++k) {
          difference[c][k] = (difference[c][k] - e.logs[b].measured[c][k]) / std::sqrt(2.0);
        }
      }
      pool.Add(difference, sum);
    }
  }
  if (noise.pairs > 0) {
    noise.rms = sum.Rms();
    noise.source = "replicates";
    return noise;
  }
  double squares = 0, count = 0;
  bool sigma = true;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    if (!pool.counts(c)) continue;
    sigma &= out.sigma > 0;
    const double s = out.sigma * e.channels[c].factor / pool.scale(c);
    squares += s * s, count += 1;
  }
  if (sigma && count > 0) {
    noise.rms = std::sqrt(squares / count);
    noise.source = "sigma";
    return noise;
  }
  for (const Log& log : e.logs) {
    auto third = log.measured;
    for (auto& y : third) {
      if (y.size() < 4) continue;
      std::vector<double> d;
      for (std::size_t k = 3; k < y.size(); ++k) {
        d.push_back((y[k] - 3 * y[k - 1] + 3 * y[k - 2] - y[k - 3]) / std::sqrt(20.0));
      }
      y = std::move(d);
    }
    pool.Add(third, sum);
  }
  noise.rms = sum.Rms();
  noise.source = "differences";
  return noise;
}

}  // namespace continuum
