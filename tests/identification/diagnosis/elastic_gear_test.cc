// ctest labels: slow
// A hidden gear that gives is found, with its spring, and its extension needs no plugin.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

// A servo turns a link through a spring, by an integrator of its own:
//
//   J θ'' = k_p (u − θ) − τ,   I q'' = τ − b q',   τ = k (θ − q) + d (θ' − q')
constexpr double kMotor = 0.03, kLink = 0.02, kServo = 8, kDamping = 0.1;  // SI
constexpr double kSpring = 40, kLoss = 0.05;
constexpr std::size_t kRows = 300;

// Commands with steps, which a gear answers by swinging.
std::vector<double> Stepped(int trial) {
  std::vector<double> u = testing::Command(trial, kRows);
  for (std::size_t k = 0; k < kRows; ++k) u[k] += k / 40 % 2 ? 0.3 : 0;
  return u;
}

std::vector<double> Turned(const std::vector<double>& u) {
  constexpr int kSteps = 500;
  constexpr double h = testing::kPeriod / kSteps;
  double motor = 0, spin = 0, q = 0, v = 0;
  std::vector<double> angle;
  for (const double input : u) {
    angle.push_back(q);
    for (int k = 0; k < kSteps; ++k) {
      const double torque = kSpring * (motor - q) + kLoss * (spin - v);
      spin += h * (kServo * (input - motor) - torque) / kMotor;
      v += h * (torque - kDamping * v) / kLink;
      motor += h * spin, q += h * v;
    }
  }
  return angle;
}

// MuJoCo's inputs act half a step early, which at the swing of 58 rad/s looks like a damper: hence
// small steps.
class HiddenGear : public testing::Bench {
 protected:
  static std::string Xml() {
    return fmt::format(
        R"(<mujoco><option timestep="0.0005" integrator="implicitfast" gravity="0 0 0"/><worldbody>
      <body name="arm"><joint name="hinge" axis="0 1 0" damping="{}" armature="{}"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 {} 1"/></body></worldbody>
      <actuator><position name="servo" joint="hinge" kp="{}"/></actuator>
      <sensor><jointpos name="angle" joint="hinge"/></sensor></mujoco>)",
        kDamping, kMotor, kLink, kServo);
  }
};

TEST_F(HiddenGear, IsNamedWithItsSpring) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  for (int trial = 0; trial < 3; ++trial) {
    const auto u = Stepped(trial);
    for (unsigned copy = 0; copy < 2; ++copy) {
      const auto q = testing::Noisy(Turned(u), 5e-4, 0, 10 * static_cast<unsigned>(trial) + copy);
      AddLog(fmt::format("t{}_{}", trial, copy),
             fmt::format("trial: t{}, use: {}", trial, trial == 2 ? "validate" : "train"), u, q);
    }
  }
  const Experiment e = ReadExperiment(
      "parameters:\n  - {name: b, target: 'joint:*', attribute: damping, initial: 0.1, lower: 0, "
      "upper: 1}\ncandidates: [elastic_gear, armature, input_gain, pt1, backlash, viscous]\n");
  DiagnosisOptions options;
  options.placebos = 0;
  const Diagnosis d = Diagnose(e, ModelSpec::Load(Write("model.xml", Xml())), options);
  ASSERT_TRUE(d.chosen()) << d.verdict.reason;
  EXPECT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "elastic_gear") << d.verdict.reason;
  const auto& x = d.chosen()->fitted.fit.x;
  ASSERT_EQ(x.size(), 3);
  EXPECT_NEAR(x[0], kDamping, 0.05 * kDamping);
  EXPECT_NEAR(x[1], 1 / kSpring, 0.05 / kSpring);
  EXPECT_NEAR(x[2], kLoss, 0.1 * kLoss);
}

}  // namespace
}  // namespace continuum
