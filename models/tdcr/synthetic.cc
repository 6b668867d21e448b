#include "models/tdcr/synthetic.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "error.h"
#include "models/tdcr/model.h"
#include "sim/numerics/portable_random.h"

namespace continuum::tdcr {
namespace {

constexpr double kGravity = 9.81, kNoise = 0.041e-3, kMaxTension = 5;

// Within 30 degrees of sideways, as a thread over a pulley pulls.
Eigen::Vector3d Sideways(Random64& random) {
  const double azimuth = std::numbers::pi * random.Uniform(-1, 1);
  const double elevation = std::numbers::pi / 6 * random.Uniform(-1, 1);
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
  Random64 random(seed);
  Experiment experiment{nominal, {}, {}};
  experiment.nominal.gravity =
      set == 1 ? Eigen::Vector3d(0, 0, kGravity) : Eigen::Vector3d(-kGravity, 0, 0);
  const Robot truth = Truth(experiment.nominal);
  const int count = set == 1 ? 40 : 30;
  for (int i = 0; i < count; ++i) {
    Case c{fmt::format("{}.{}", set, i + 1), NoLoads(experiment.nominal)};
    for (double& t : c.loads.tension) t = kMaxTension * random.Uniform();
    if (set == 2) {
      c.loads.tip_force = {-0.03 * kGravity, 0, 0};
    } else if (i % 2 == 1) {
      const Eigen::Vector3d direction = Sideways(random);
      c.loads.tip_force = 0.05 * kGravity * random.Uniform() * direction;
    }
    Loads loads = c.loads;
    loads.mu = truth.mu;
    const Solution solution = SolveCase(truth, loads, Method::kCrtFriction);
    if (!solution.outcome.ok()) throw Error::Job("synthetic case: " + solution.outcome.why);
    Measured m{c.name, i >= count - 10, truth.MeasuringToBase().transpose() * solution.disks};
    for (double& coordinate : m.disks.reshaped()) coordinate += kNoise * random.Normal();
    experiment.cases.push_back(std::move(c));
    experiment.measured.push_back(std::move(m));
  }
  return experiment;
}

}  // namespace continuum::tdcr
