#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/smooth.h"

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

/// Sensitivities of the first log against central differences of fourth order of runs at 1e-11, in
/// steps of 1e-3 of the value: their own error is some 1e-7.
inline void ExpectCentralDifferences(const Experiment& e, const Gradient& g) {
  const System system = System::Load(e.model);
  const auto at = [&](double relative) {
    const std::vector<Change> changes{{g.target, g.attribute, g.value * (1 + relative)}};
    return std::make_unique<Flow>(system.Build(changes), e, e.logs[0]);
  };
  constexpr double kStep = 1e-3;
  std::vector<Trace> runs;
  for (const int steps : {-2, -1, 1, 2})
    runs.push_back(FollowFlow(*at(steps * kStep), {}, e, e.logs[0], {1e-11, 1e-13, false}).trace);
  std::vector<std::unique_ptr<Flow>> neighbour;
  neighbour.push_back(at(kMove));
  const auto flow = at(0);
  SmoothTraces traces = FollowFlow(*flow, neighbour, e, e.logs[0], {1e-10, 1e-13, false});
  MeasureTrace(e, flow->wiring(), e.logs[0], traces.moved[0]);
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    double off = 0, size = 0;
    for (std::size_t k = 0; k < e.logs[0].rows(); ++k) {
      const auto y = [&](int run) { return runs[run].channel[c][k]; };
      const double expected = (y(0) - 8 * y(1) + 8 * y(2) - y(3)) / (12 * kStep);
      const double found = (traces.moved[0].channel[c][k] - traces.trace.channel[c][k]) / kMove;
      off = std::max(off, std::abs(found - expected));
      size = std::max(size, std::abs(expected));
    }
    EXPECT_LT(off, 1e-5 * size + 1e-9) << e.channels[c].name;
  }
}

}  // namespace continuum::testing
