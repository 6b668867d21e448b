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

// Difference of two motions in units of the noise, over all outputs.
double Apart(const Robot& robot, const Columns& a, const Columns& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(Rms(a[i], b[i]) / robot.sigma[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class Machines : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Outside, Machines,
                         ::testing::Values("pendulum", "valve", "two_link", "snake", "winch_snake",
                                           "soft"),
                         [](const auto& info) { return std::string(info.param); });

// With nothing hidden a machine moves as its model does in MuJoCo at a step of 0.1 ms. What is left
// is the error of that step, the largest (0.75 of the noise) after the pendulum's first swings; the
// chain in place of the arc of `soft` leaves 0.5.
TEST_P(Machines, MoveAsTheirModelsDo) {
  const Robot& robot = RobotNamed(GetParam());
  std::mt19937_64 rng(7);
  Columns u = robot.drive(0, rng);
  NativeTruth truth{robot.model};
  if (robot.name == "pendulum") {
    u[1].assign(u[1].size(), 1);  // MuJoCo's motor is never off
    truth.start = {1.2};
  }
  Columns mujoco = RunNative(truth, u);
  const Columns own = robot.run({}, 0, u);
  if (mujoco.size() > own.size()) mujoco.erase(mujoco.end() - 2);  // y of the tip
  ASSERT_EQ(mujoco.size(), own.size());
  EXPECT_LT(Apart(robot, own, mujoco), 0.9);
}

// Every effect that a case of the suite hides moves its machine by more than the noise.
TEST_P(Machines, ShowWhatIsHidden) {
  const Robot& robot = RobotNamed(GetParam());
  std::mt19937_64 rng(7);
  const Columns u = robot.drive(0, rng);
  const Columns plain = robot.run({}, 0, u);
  for (const Case& c : OutsideCases(false)) {
    if (c.robot != robot.name || c.effects.size() != 1 || c.law == Law::kNative) continue;
    const double size = robot.Named(c.effects.front()).size * c.factor;
    const Amounts hidden{{c.effects.front(), size}, {"law", static_cast<double>(c.law)}};
    EXPECT_GT(Apart(robot, plain, robot.run(hidden, 0, u)), 1.5) << c.Name();
  }
}

// The four ways to make dry friction are of one size.
TEST(DryFriction, IsTheSameByEveryLaw) {
  const Robot& robot = RobotNamed("valve");
  std::mt19937_64 rng(7);
  const Columns u = robot.drive(0, rng);
  const auto with = [&](Law law) {
    return robot.run({{"coulomb", 2.4}, {"law", static_cast<double>(law)}}, 0, u);
  };
  const double effect = Apart(robot, robot.run({}, 0, u), with(Law::kStick));
  EXPECT_GT(effect, 50);
  for (const Law law : {Law::kTanh, Law::kBristles, Law::kNative})
    EXPECT_LT(Apart(robot, with(Law::kStick), with(law)), 0.1 * effect) << static_cast<int>(law);
}

}  // namespace
}  // namespace continuum::hidden
