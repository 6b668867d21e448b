// Friction of cables as a differential equation: a load over a pin by its closed form, an arm by
// small steps, and sensitivities across rest and sliding.
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "binding/bristle.h"
#include "gradient.h"
#include "identification/problem/path_choice.h"
#include "sim/simulation/simulate.h"
#include "smooth_arm.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Gradient;

constexpr double kMass = 2, kMu = 0.2, kGravity = 9.81, kWrap = std::numbers::pi / 2;

std::string Capstan(const std::string& tendon) {
  return fmt::format(
      "<extension><plugin plugin='continuum.capstan'><instance name='law'><config key='tendon' "
      "value='{}'/><config key='mu' value='{}'/></instance></plugin></extension>",
      tendon, kMu);
}

// A load hangs from a cable that a motor pulls over a pin, a quarter of a turn:
//
//   m z'' = T₀ e^(∓μθ) − m g,   − as it rises, + as it sinks
std::string Load() {
  return fmt::format(
      "<mujoco><option timestep='1e-3' integrator='implicitfast'/>{}<worldbody><site name='a' "
      "pos='-1 0 0'/><site name='b'/><body name='load' pos='0 0 -1'><joint name='z' type='slide' "
      "axis='0 0 1'/><inertial pos='0 0 0' mass='{}' diaginertia='1 1 1'/><site name='c'/></body>"
      "</worldbody><tendon><spatial name='t'><site site='a'/><site site='b'/><site site='c'/>"
      "</spatial></tendon><actuator><motor name='pull' tendon='t' gear='-1'/></actuator><sensor>"
      "<jointpos name='z' joint='z'/><jointvel name='v' joint='z'/><plugin name='tension' "
      "plugin='continuum.capstan' instance='law' objtype='site' objname='c'/></sensor></mujoco>",
      Capstan("t"), kMass);
}

class CableBristleTest : public testing::Bench {
 protected:
  // A steady pull, as a multiple of the load's weight.
  Experiment Read(double pull) {
    std::string csv = "time,pull,z,v,T\n";
    for (int k = 0; k <= 20; ++k)
      csv += fmt::format("{:.3f},{:.12g},0,0,0\n", 0.02 * k, pull * kMass * kGravity);
    Write("model.xml", Load()), Write("log.csv", csv);
    return Experiment::Read(
        Write("e.yaml",
              "format: 1\nmodel: model.xml\nstart: rest\n"
              "inputs: [{column: pull, unit: N, actuator: pull}]\n"
              "outputs: [{column: z, unit: m, sensor: z}, {column: v, unit: m/s, sensor: v},\n"
              "          {column: T, unit: N, sensor: tension}]\n"
              "logs: [{file: log.csv}]\n"));
  }
  static Trace Run(const Experiment& e, const SolverOptions& how = {}) {
    ContinuousDynamics dynamics(ModelSpec::Load(e.model).Build(), e, e.logs[0]);
    EXPECT_TRUE(dynamics.rubs());
    const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], how);
    EXPECT_FALSE(traces.trace.diverged) << traces.trace.Failure();
    return traces.trace;
  }
};

// Between W e^(−μθ) and W e^(μθ) it gives by its give at most, and then not at all.
TEST_F(CableBristleTest, HoldsALoadWithoutDriftInTheWholeBand) {
  for (const double share : {-0.99, -0.5, 0.5, 0.99}) {
    const Trace trace = Run(Read(std::exp(share * kMu * kWrap)));
    const auto& z = trace.channel[0];
    EXPECT_LT(std::abs(z.back()), 3 * Bristle::kGive) << share;
    EXPECT_NEAR(z.back(), z[17], 1e-9) << share;
    EXPECT_NEAR(trace.channel[2].back(), kMass * kGravity, 1e-5 * kMass * kGravity) << share;
  }
}

TEST_F(CableBristleTest, SlidesUnderTheCapstanItself) {
  for (const double side : {-1.0, 1.0}) {
    const double pull = std::exp(side * 1.5 * kMu * kWrap),
                 tension = pull * std::exp(-side * kMu * kWrap) * kMass * kGravity,
                 acceleration = tension / kMass - kGravity;
    const Trace trace = Run(Read(pull), {1e-8, 1e-10, true});
    for (std::size_t k = 5; k <= 20; ++k) {
      const double t = 0.02 * static_cast<double>(k);
      EXPECT_NEAR(trace.channel[1][k], acceleration * t, 0.01 * std::abs(acceleration) * t) << t;
      EXPECT_NEAR(trace.channel[2][k], tension, 1e-6 * tension) << t;
    }
  }
}

TEST_F(CableBristleTest, OfACableThatNothingPullsHasNoStates) {
  const Experiment slack = Read(0), tight = Read(1);
  const ModelSpec system = ModelSpec::Load(slack.model);
  EXPECT_EQ(ContinuousDynamics(system.Build(), slack, slack.logs[0]).size(), 2u);
  EXPECT_EQ(ContinuousDynamics(system.Build(), tight, tight.logs[0]).size(), 3u);
}

// ∂v/∂μ = ∓θ T t/m once it slides, but for the moment in which it gives.
TEST_F(CableBristleTest, SensitivitiesAreThoseOfTheClosedForm) {
  const double pull = std::exp(1.5 * kMu * kWrap);
  const auto slopes = testing::Slopes(Read(pull), {"Mu", "plugin:law", "mu", kMu},
                                      {kPerturbation, {1e-9, 1e-11, true}});
  const double by_mu = -kWrap * pull * std::exp(-kMu * kWrap) * kGravity;  // of v, a second
  for (std::size_t k = 10; k <= 20; ++k) {
    const double t = 0.02 * static_cast<double>(k);
    EXPECT_NEAR(slopes[1][k] / kMu, by_mu * t, 0.02 * std::abs(by_mu) * t) << t;
  }
}

class CableBristleArmTest : public testing::Bench, public ::testing::WithParamInterface<Gradient> {
 protected:
  Experiment Read() {
    Write("model.xml", testing::SmoothArm(Capstan("ta")));
    Write("log.csv", testing::SmoothLog(60));
    return Experiment::Read(Write("e.yaml", testing::kSmoothExperiment));
  }
};

// Steps slide at once, a bristle after its give.
TEST_F(CableBristleArmTest, BendsAsSmallStepsDo) {
  const Experiment e = Read();
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  EXPECT_EQ(SmoothObstacle(problem), "");
  ModelAndData machine = system.Build();
  machine.model->opt.timestep = 2e-5;
  const Trace steps = Simulate(machine, e, e.logs[0]);
  ContinuousDynamics dynamics(system.Build(), e, e.logs[0]);
  const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], {1e-8, 1e-10, true});
  ASSERT_FALSE(traces.trace.diverged) << traces.trace.Failure();
  EXPECT_LT(testing::Apart(traces.trace, steps), 0.02);
}

TEST_P(CableBristleArmTest, HasTheSensitivitiesOfTightCentralDifferences) {
  const Experiment e = Read();
  const SolverOptions tight{1e-11, 1e-13, true};
  const auto found = testing::Slopes(e, GetParam(), {kPerturbation, {1e-10, 1e-12, true}});
  EXPECT_LT(testing::SlopeError(found, testing::CentralDifferences(e, GetParam(), 1e-4, tight)),
            1e-5);
}

INSTANTIATE_TEST_SUITE_P(Attribute, CableBristleArmTest,
                         ::testing::Values(Gradient{"Mu", "plugin:law", "mu", kMu},
                                           Gradient{"Stiffness", "joint:y*", "stiffness", 0.6},
                                           Gradient{"Gain", "actuator:pull", "gainprm[0]", -1}),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace continuum
