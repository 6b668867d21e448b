#include <cmath>

#include <gtest/gtest.h>

#include "hidden_effects/outside/cases.h"
#include "hidden_effects/outside/native.h"

namespace continuum::hidden {
namespace {

double Rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class Machines : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Outside, Machines,
                         ::testing::Values("pendulum", "valve", "two_link", "snake", "winch_snake",
                                           "soft"),
                         [](const auto& info) { return std::string(info.param); });

// With nothing hidden a machine moves as its model does in MuJoCo at a fine step: within a quarter
// of the sensors' noise.
TEST_P(Machines, MoveAsTheirModelsDo) {
  const Robot& robot = RobotNamed(GetParam());
  std::mt19937_64 rng(7);
  for (int trial = 0; trial < 2; ++trial) {
    Columns u = robot.drive(trial, rng);
    if (robot.name == "pendulum") u[1].assign(u[1].size(), 1);
    const Columns own = robot.run({}, trial, u);
    NativeTruth truth{robot.model};
    if (robot.name == "pendulum")
      truth.start = {trial ? 2.7 : 1.2}, truth.speed = {trial ? 4.5 : 0};
    Columns mujoco = RunNative(truth, u);
    if (mujoco.size() > own.size()) mujoco.erase(mujoco.end() - 2);  // y of the tip
    for (std::size_t i = 0; i < own.size(); ++i)
      printf("%s %d %zu  %g of %g, size %g\n", robot.name.c_str(), trial, i, Rms(own[i], mujoco[i]),
             robot.sigma[i], Rms(own[i], Columns(1, std::vector<double>(400, own[i][0]))[0]));
  }
}

TEST_P(Machines, Sizes) {
  const Robot& robot = RobotNamed(GetParam());
  for (const Hidden& h : robot.effects) {
    for (int law = 0; law < ((h.parameter == "tau_c" || h.parameter == "mu_l") ? 3 : 1); ++law) {
      printf("%s %s law %d %g:", robot.name.c_str(), h.name.c_str(), law, h.size);
      std::mt19937_64 rng(7);
      for (int trial = 0; trial < robot.trials; ++trial) {
        Columns u = robot.drive(trial, rng);
        const Columns own = robot.run({}, trial, u);
        const Columns with = robot.run({{h.name, h.size}, {"law", law}}, trial, u);
        double sum = 0;
        for (std::size_t i = 0; i < own.size(); ++i)
          sum += std::pow(Rms(own[i], with[i]) / robot.sigma[i], 2);
        printf(" %.3g", std::sqrt(sum / double(own.size())));
      }
      printf("\n");
    }
  }
}

}  // namespace
}  // namespace continuum::hidden
