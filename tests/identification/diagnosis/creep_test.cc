// ctest labels: slow
// A hidden creep of any time that the logs show is found.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

// A joint on a spring with a Maxwell element beside it, by an integrator of its own:
//
//   J q'' = u − b q' − k q − k_m e,   e' = q' − e/τ_m
constexpr double kInertia = 0.02, kDamping = 0.03, kSpring = 1.5, kCreep = 0.6;
constexpr std::size_t kRows = 400;  // 4 s

std::vector<double> Creeping(const std::vector<double>& u, double tau) {
  constexpr int kSteps = 200;
  constexpr double h = testing::kPeriod / kSteps;
  double q = 0, v = 0, e = 0;
  std::vector<double> angle;
  for (const double input : u) {
    angle.push_back(q);
    for (int k = 0; k < kSteps; ++k) {
      v += h * (input - kDamping * v - kSpring * q - kCreep * e) / kInertia;
      q += h * v;
      e += h * (v - e / tau);
    }
  }
  return angle;
}

class HiddenCreep : public testing::Bench, public ::testing::WithParamInterface<double> {};

TEST_P(HiddenCreep, IsNamedWithItsTime) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const double tau = GetParam();
  for (int trial = 0; trial < 2; ++trial) {
    const auto u = testing::Command(trial, kRows);
    for (unsigned copy = 0; copy < 2; ++copy) {
      const auto q =
          testing::Noisy(Creeping(u, tau), 1e-3, 0, 10 * static_cast<unsigned>(trial) + copy);
      AddLog(fmt::format("t{}_{}", trial, copy),
             fmt::format("trial: t{}, use: {}", trial, trial ? "validate" : "train"), u, q);
    }
  }
  const std::string model = fmt::format(
      R"(<mujoco><option timestep="0.002" integrator="implicitfast" gravity="0 0 0"/><worldbody>
      <body name="arm"><joint name="q" axis="0 1 0" damping="{}" stiffness="{}"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 {} 1"/></body></worldbody>
      <actuator><motor name="servo" joint="q"/></actuator>
      <sensor><jointpos name="angle" joint="q"/></sensor></mujoco>)",
      kDamping, kSpring, kInertia);
  const Experiment e = ReadExperiment("candidates: [maxwell, coulomb, stiffness, viscous]\n");
  DiagnosisOptions options;
  options.placebos = 0;
  options.iterations = 8;
  const Diagnosis d = Diagnose(e, ModelSpec::Load(Write("model.xml", model)), options);
  ASSERT_TRUE(d.chosen()) << d.verdict.reason;
  EXPECT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "maxwell") << d.verdict.reason;
  const auto& x = d.chosen()->fitted.fit.x;
  EXPECT_NEAR(x[0], kCreep, 0.1 * kCreep);
  EXPECT_NEAR(x[1], tau, 0.1 * tau);
}

INSTANTIATE_TEST_SUITE_P(Times, HiddenCreep, ::testing::Values(0.05, 0.2, 1.0, 3.0));

}  // namespace
}  // namespace continuum
