#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/sensitivity/smooth_path.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace_measurement.h"

namespace continuum::testing {

/// Largest difference of any channel, over the size of that channel.
inline double Apart(const Trace& a, const Trace& b) {
  double apart = 0;
  for (std::size_t c = 0; c < a.channel.size(); ++c) {
    double size = 1e-3, off = 0;
    for (std::size_t k = 0; k < a.channel[c].size(); ++k) {
      size = std::max(size, std::abs(b.channel[c][k]));
      off = std::max(off, std::abs(a.channel[c][k] - b.channel[c][k]));
    }
    apart = std::max(apart, off / size);
  }
  return apart;
}

/// An attribute of a model and its value there.
struct Gradient {
  std::string name, target, attribute;
  double value;
};

inline void PrintTo(const Gradient& g, std::ostream* out) {
  *out << g.target << " " << g.attribute;
}

/// How sensitivities are found; a test of them has to see any other way.
struct Sensitivities {
  double move = kPerturbation;  ///< relative, of the perturbed's parameter
  SolverOptions how{1e-10, 1e-13, false};
};

inline std::unique_ptr<ContinuousDynamics> FlowBeside(const Experiment& e, const Gradient& g,
                                                      double relative) {
  const ModelSpec system = ModelSpec::Load(e.model);
  const std::vector<Change> changes{{g.target, g.attribute, g.value * (1 + relative)}};
  return std::make_unique<ContinuousDynamics>(system.Build(changes), e, e.logs[0]);
}

/// d channel / d ln(value) of the first log: [channel][row].
inline std::vector<std::vector<double>> Slopes(const Experiment& e, const Gradient& g,
                                               const Sensitivities& s = {}) {
  std::vector<std::unique_ptr<ContinuousDynamics>> perturbed;
  perturbed.push_back(FlowBeside(e, g, s.move));
  const auto dynamics = FlowBeside(e, g, 0);
  SmoothTraces traces = SimulateSmooth(*dynamics, perturbed, e, e.logs[0], s.how);
  MeasureTrace(e, dynamics->wiring(), e.logs[0], traces.perturbed[0]);
  auto slopes = traces.perturbed[0].channel;
  for (std::size_t c = 0; c < slopes.size(); ++c) {
    for (std::size_t k = 0; k < slopes[c].size(); ++k)
      slopes[c][k] = (slopes[c][k] - traces.trace.channel[c][k]) / kPerturbation;
  }
  return slopes;
}

/// Largest difference of slopes, over the largest slope of the same channel.
inline double SlopeError(const std::vector<std::vector<double>>& found,
                         const std::vector<std::vector<double>>& expected) {
  double worst = 0;
  for (std::size_t c = 0; c < expected.size(); ++c) {
    double off = 0, size = 1e-4;
    for (std::size_t k = 0; k < expected[c].size(); ++k) {
      off = std::max(off, std::abs(found[c][k] - expected[c][k]));
      size = std::max(size, std::abs(expected[c][k]));
    }
    worst = std::max(worst, off / size);
  }
  return worst;
}

/// The same slopes by central differences of fourth order of runs at 1e-11, in steps of 1e-3 of the
/// value: their own error is some 1e-7.
inline std::vector<std::vector<double>> CentralDifferences(const Experiment& e, const Gradient& g,
                                                           double step = 1e-3,
                                                           SolverOptions how = {1e-11, 1e-13,
                                                                                false}) {
  std::vector<Trace> runs;
  for (const int steps : {-2, -1, 1, 2}) {
    const auto dynamics = FlowBeside(e, g, steps * step);
    runs.push_back(SimulateSmooth(*dynamics, {}, e, e.logs[0], how).trace);
  }
  auto slopes = runs[0].channel;
  for (std::size_t c = 0; c < slopes.size(); ++c) {
    for (std::size_t k = 0; k < slopes[c].size(); ++k) {
      const auto y = [&](int run) { return runs[run].channel[c][k]; };
      slopes[c][k] = (y(0) - 8 * y(1) + 8 * y(2) - y(3)) / (12 * step);
    }
  }
  return slopes;
}

}  // namespace continuum::testing
