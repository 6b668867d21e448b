// Dry friction as a differential equation: true stick, exact sliding, and sensitivities across
// both.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "binding/bristle.h"
#include "gradient.h"
#include "identification/fit/fit.h"
#include "identification/problem/path_choice.h"
#include "sim/simulation/simulate.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Gradient;
using ::testing::HasSubstr;

// A block of 1 kg on a slide with dry friction; pull: a steady force along it [N].
std::string Block(const std::string& law, double pull, double stiffness = 0) {
  return fmt::format(
      "<mujoco><option timestep='1e-3' integrator='implicitfast' gravity='{} 0 0'/><extension>{}"
      "</extension><worldbody><body name='block'><joint name='x' type='slide' axis='1 0 0' "
      "stiffness='{}'/>"
      "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody><actuator><motor "
      "name='f' joint='x'/></actuator><sensor><jointpos name='x' joint='x'/><jointvel name='v' "
      "joint='x'/></sensor></mujoco>",
      pull, law, stiffness);
}

std::string Law(const std::string& name, const std::vector<std::pair<std::string, double>>& keys) {
  std::string config = "<config key='joint' value='x'/>";
  for (const auto& [key, value] : keys)
    config += fmt::format("<config key='{}' value='{}'/>", key, value);
  return "<plugin plugin='continuum." + name + "'><instance name='law'>" + config +
         "</instance></plugin>";
}

const std::string kCoulomb = Law("coulomb", {{"tau_c", 1}});
const std::string kStribeck =
    Law("stribeck", {{"tau_mu", 0.2}, {"tau_c", 1}, {"S", 0.6}, {"v_d", 0.3}});

class BristleTest : public testing::Bench {
 protected:
  // Rows every `period`; the block begins with a speed; the motor swings.
  Experiment Read(const std::string& model, double speed, double swing, int rows, double period,
                  const std::string& parameters = "") {
    std::string csv = "time,f,x,v\n";
    for (int k = 0; k < rows; ++k) {
      const double t = k * period;
      csv += fmt::format("{:.6f},{:.9f},0,{}\n", t, swing * std::sin(3 * t), k ? 0 : speed);
    }
    Write("model.xml", model), Write("log.csv", csv);
    return Experiment::Read(
        Write("e.yaml",
              "format: 1\nmodel: model.xml\nstart: measured\n"
              "inputs: [{column: f, unit: N, actuator: f, interpolate: linear}]\n"
              "outputs: [{column: x, unit: m, sensor: x, sigma: 0.001},\n"
              "          {column: v, unit: m/s, sensor: v, sigma: 0.01}]\n"
              "logs: [{file: log.csv, use: train}]\n" +
                  parameters));
  }
  static Trace Run(const Experiment& e, const SolverOptions& how = {}) {
    ContinuousDynamics dynamics(ModelSpec::Load(e.model).Build(), e, e.logs[0]);
    const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], how);
    EXPECT_FALSE(traces.trace.diverged) << traces.trace.Failure();
    return traces.trace;
  }
};

// A bristle gives by its give at most, and then not at all: the load is 0.9 of the breakaway.
TEST_F(BristleTest, HoldsALoadWithoutDrift) {
  const Trace trace = Run(Read(Block(kCoulomb, 0.9), 0, 0, 21, 0.5));
  const auto& x = trace.channel[0];
  EXPECT_GT(x[1], 0);
  EXPECT_LT(x[1], Bristle::kGive);
  for (std::size_t k = 2; k < x.size(); ++k) EXPECT_NEAR(x[k], x[1], 1e-10) << "row " << k;
}

// Within 1 %, though the load comes as a blow: the block stops once more.
TEST_F(BristleTest, BreaksAwayAtItsLevel) {
  const Trace held = Run(Read(Block(kStribeck, 0.99 * 1.6), 0, 0, 5, 0.5));
  EXPECT_LT(held.channel[0].back(), 10 * Bristle::kGive);
  EXPECT_NEAR(held.channel[0][4], held.channel[0][2], 1e-10);
  const Trace slides = Run(Read(Block(kStribeck, 1.01 * 1.6), 0, 0, 5, 0.5));
  EXPECT_GT(slides.channel[0].back(), 1e3 * Bristle::kGive);
}

// v = v₀ − τ_c t/m up to the stop at 2.03 s, then nothing moves.
TEST_F(BristleTest, SlidesUnderTheLevelItself) {
  constexpr double kSpeed = 2.03;
  const Trace trace = Run(Read(Block(kCoulomb, 0), kSpeed, 0, 41, 0.1));
  for (std::size_t k = 0; k < trace.channel[1].size(); ++k) {
    const double v = std::max(0.0, kSpeed - 0.1 * static_cast<double>(k));
    EXPECT_NEAR(trace.channel[1][k], v, 1e-6) << "row " << k;
  }
  EXPECT_NEAR(trace.channel[0].back(), kSpeed * kSpeed / 2, 2 * Bristle::kGive);
}

// The row of the plugin breaks away at once, the bristle after its give: 1 ms later.
TEST_F(BristleTest, SticksAndSlidesAsSmallStepsDo) {
  const Experiment e = Read(Block(kStribeck, 0), 0, 2, 151, 0.02);
  ModelAndData machine = ModelSpec::Load(e.model).Build();
  machine.model->opt.timestep = 1e-4;
  EXPECT_LT(testing::Apart(Run(e), Simulate(machine, e, e.logs[0])), 0.01);
}

class BristleGradientTest : public BristleTest, public ::testing::WithParamInterface<Gradient> {};

// From rest, through slips and rests of a whole swing and a half.
TEST_P(BristleGradientTest, AgreesWithTightCentralDifferences) {
  const Gradient& g = GetParam();
  const Experiment e = Read(Block(kStribeck, 0.1), 0.5, 2, 31, 0.1);
  const SolverOptions tight{1e-11, 1e-13, true};
  const auto found = testing::Slopes(e, g, {kPerturbation, {1e-10, 1e-12, true}});
  EXPECT_LT(testing::SlopeError(found, testing::CentralDifferences(e, g, 1e-4, tight)), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Attribute, BristleGradientTest,
                         ::testing::Values(Gradient{"Mass", "body:block", "mass", 1},
                                           Gradient{"Gear", "actuator:f", "gear", 1},
                                           Gradient{"Viscous", "plugin:law", "tau_mu", 0.2},
                                           Gradient{"Level", "plugin:law", "tau_c", 1},
                                           Gradient{"Excess", "plugin:law", "S", 0.6},
                                           Gradient{"Speed", "plugin:law", "v_d", 0.3}),
                         [](const auto& param) { return param.param.name; });

// Where sliding lasts the slope has a closed form, and it stays after the stop:
// ∂v/∂τ_c = −t/m, ∂x/∂τ_c = −m v₀²/(2 τ_c²).
TEST_F(BristleTest, SensitivitiesAreThoseOfTheClosedForm) {
  constexpr double kSpeed = 2.03;
  const Experiment e = Read(Block(kCoulomb, 0), kSpeed, 0, 41, 0.1);
  const auto slopes =
      testing::Slopes(e, {"Level", "plugin:law", "tau_c", 1}, {kPerturbation, {1e-9, 1e-11, true}});
  for (std::size_t k = 0; k < 20; ++k)
    EXPECT_NEAR(slopes[1][k], -0.1 * static_cast<double>(k), 1e-5);
  EXPECT_NEAR(slopes[1].back(), 0, 1e-5);
  EXPECT_NEAR(slopes[0].back(), -kSpeed * kSpeed / 2, 2 * Bristle::kGive);
}

TEST_F(BristleTest, FitsFrictionFromItsOwnMotion) {
  Experiment e = Read(Block(kStribeck, 0), 0.5, 2, 301, 0.02,
                      "parameters:\n"
                      "  - {name: tau_c, target: 'plugin:law', attribute: tau_c, initial: 0.8, "
                      "lower: 0.1, upper: 5}\n"
                      "  - {name: S, target: 'plugin:law', attribute: S, initial: 0.4, lower: 0, "
                      "upper: 5}\n");
  const Trace truth = Run(e, {1e-9, 1e-11, true});
  for (std::size_t c = 0; c < 2; ++c) e.logs[0].measured[c] = truth.channel[c];
  const ModelSpec system = ModelSpec::Load(e.model);
  Problem problem(e, system);
  ASSERT_EQ(SmoothObstacle(problem), "");
  problem.Follow(Path::kSmooth);
  const Fit fit = FitParameters(problem, problem.Start(), problem.AllLogs());
  EXPECT_NEAR(fit.x[0], 1, 1e-4);
  EXPECT_NEAR(fit.x[1], 0.6, 1e-3);
}

// Which of both is cheaper is counted: one stop, or ninety turns of a stiff spring.
TEST_F(BristleTest, StepsWhereThatIsCheaper) {
  const Experiment stops = Read(Block(kStribeck, 0), 0.5, 0, 101, 0.02);
  EXPECT_EQ(SmoothCost(Problem(stops, ModelSpec::Load(stops.model))), "");
  const Experiment swings = Read(Block(kCoulomb, 0, 2e4), 3, 0, 101, 0.02);
  EXPECT_THAT(
      SmoothCost(Problem(swings, ModelSpec::Load(swings.model))),
      AllOf(HasSubstr("evaluations of the motion for the first"), HasSubstr(" 2000 steps")));
}

}  // namespace
}  // namespace continuum
