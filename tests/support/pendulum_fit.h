#pragma once

#include <string>

#include "identification/fit/fit.h"
#include "support/pendulum.h"

namespace continuum::testing {

inline const std::string kDamping =
    "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.05, lower: 0, upper: 1}\n";
inline const std::string kFriction =
    "  - {name: tau_c, target: 'plugin:dry', attribute: tau_c, initial: 0.01, lower: 0, upper: "
    "1}\n";
inline const std::string kBob =
    "  - {name: bob, target: 'body:arm', attribute: mass, initial: 0.2, lower: 0.05, upper: 1}\n";

/// Fits of pendulums that MuJoCo did not simulate.
class FitTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 200;

  ModelSpec Model(const Pendulum& p, const std::string& extension = "", double timestep = 5e-4) {
    return ModelSpec::Load(Write("model.xml", p.Xml(extension, timestep)));
  }
  // Trials of a pendulum with noise, all for training.
  void AddTrials(const Pendulum& p, int count, double sigma = 0) {
    for (int t = 0; t < count; ++t) {
      const auto u = Command(t, kRows);
      AddLog("t" + std::to_string(t), "use: train", u,
             Noisy(p.Run(u, kPeriod), sigma, 0, static_cast<unsigned>(t + 1)));
    }
  }
  static Fit FitAll(const Problem& problem) {
    return FitParameters(problem, problem.Start(), problem.TrainLogs());
  }
};

}  // namespace continuum::testing
