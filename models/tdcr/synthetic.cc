#include "models/tdcr/synthetic.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "error.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {
namespace {

constexpr double kGravity = 9.81, kNoise = 0.041e-3, kMaxTension = 5;

// Within 30 degrees of sideways, as a thread over a pulley pulls.
Eigen::Vector3d Sideways(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(-1, 1);
  const double azimuth = std::numbers::pi * share(random);
  const double elevation = std::numbers::pi / 6 * share(random);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace

Robot Truth(const Robot& nominal) {
  Robot truth = nominal;
  truth.E *= 0.85;
  truth.mu = 0.15;
  truth.base_rotation = {0.02, -0.03, 0.05};
  truth.natural = {0.8, 0, 2};
  return truth;
}

Experiment Synthesize(const Robot& nominal, int set, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, kNoise);
  Experiment experiment{nominal, {}, {}};
  experiment.nominal.gravity =
      set == 1 ? Eigen::Vector3d(0, 0, kGravity) : Eigen::Vector3d(-kGravity, 0, 0);
  const Robot truth = Truth(experiment.nominal);
  const int count = set == 1 ? 40 : 30;
  for (int i = 0; i < count; ++i) {
    Case c{fmt::format("{}.{}", set, i + 1), NoLoads(experiment.nominal)};
    for (double& t : c.loads.tension) t = kMaxTension * share(random);
    if (set == 2) {
      c.loads.tip_force = {-0.03 * kGravity, 0, 0};
    } else if (i % 2 == 1) {
      c.loads.tip_force = 0.05 * kGravity * share(random) * Sideways(random);
    }
    Loads loads = c.loads;
    loads.mu = truth.mu;
    const Solution solution = SolveCase(truth, loads, Method::kCrtFriction);
    if (!solution.outcome.ok()) throw Error::Job("synthetic case: " + solution.outcome.why);
    Measured m{c.name, i >= count - 10, truth.MeasuringToBase().transpose() * solution.disks};
    for (double& coordinate : m.disks.reshaped()) coordinate += noise(random);
    experiment.cases.push_back(std::move(c));
    experiment.measured.push_back(std::move(m));
  }
  return experiment;
}

}  // namespace continuum::tdcr
