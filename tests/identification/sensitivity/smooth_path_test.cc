#include "identification/sensitivity/smooth_path.h"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "gradient.h"
#include "identification/fit/fit.h"
#include "identification/problem/path_choice.h"
#include "sim/simulation/simulate.h"
#include "smooth_arm.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Apart;
using testing::CentralDifferences;
using testing::Gradient;
using ::testing::HasSubstr;
using testing::kSmoothExperiment;
using testing::SlopeError;
using testing::Slopes;
using testing::SmoothArm;
using testing::SmoothLog;

class SmoothTest : public testing::Bench {
 protected:
  Experiment Read(const std::string& model, const std::string& parameters = "", int rows = 60) {
    Write("model.xml", model);
    Write("log.csv", SmoothLog(rows));
    return Experiment::Read(Write("e.yaml", kSmoothExperiment + parameters));
  }
};

// MuJoCo's act and inputs are held over a step, half a step late, whatever the integrator: 5 us.
TEST_F(SmoothTest, AgreesWithSmallStepsOfMuJoCo) {
  const Experiment e = Read(SmoothArm());
  const ModelSpec system = ModelSpec::Load(e.model);
  ModelAndData machine = system.Build();
  machine.model->opt.integrator = mjINT_RK4;
  machine.model->opt.timestep = 1e-5;
  const Trace steps = Simulate(machine, e, e.logs[0]);
  for (const bool stiff : {false, true}) {
    ContinuousDynamics dynamics(system.Build(), e, e.logs[0]);
    const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], {1e-8, 1e-10, stiff});
    ASSERT_FALSE(traces.trace.diverged) << traces.trace.Failure();
    EXPECT_LT(Apart(traces.trace, steps), 2e-4) << (stiff ? "BDF" : "Adams");
  }
}

class GradientTest : public SmoothTest, public ::testing::WithParamInterface<Gradient> {};

std::string Law(const std::string& name, const std::string& config) {
  return "<extension><plugin plugin='continuum." + name + "'><instance name='law'>" + config +
         "</instance></plugin></extension>";
}

const std::string kCreep = Law("maxwell",
                               "<config key='joint' value='x*'/><config key='k_m' value='0.3'/>"
                               "<config key='tau_m' value='0.2'/>");

TEST_P(GradientTest, AgreesWithTightCentralDifferences) {
  CONTINUUM_LONG_IF_SANITIZED("a solver with tight tolerances");
  const Gradient& g = GetParam();
  const Experiment e = Read(SmoothArm(g.target.starts_with("plugin:") ? kCreep : ""));
  EXPECT_LT(SlopeError(Slopes(e, g), CentralDifferences(e, g)), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Attribute, GradientTest,
                         ::testing::Values(Gradient{"Mass", "body:link1", "mass", 0.1},
                                           Gradient{"Stiffness", "joint:y*", "stiffness", 0.6},
                                           Gradient{"Damping", "joint:x*", "damping", 0.02},
                                           Gradient{"SpringRef", "joint:x1", "springref", 0.1},
                                           Gradient{"Armature", "joint:x*", "armature", 2e-4},
                                           Gradient{"Gear", "actuator:lagged", "gear", 1.5},
                                           Gradient{"Gain", "actuator:pull", "gainprm[0]", -1},
                                           Gradient{"Lag", "actuator:lagged", "dynprm[0]", 0.04},
                                           Gradient{"CableStiffness", "tendon:tb", "stiffness", 20},
                                           Gradient{"Site", "site:a1", "pos[0]", 0.03},
                                           Gradient{"Body", "body:link2", "pos[2]", -0.1},
                                           Gradient{"Gravity", "option", "gravity[2]", -9.81},
                                           Gradient{"Creep", "plugin:law", "k_m", 0.3},
                                           Gradient{"CreepTime", "plugin:law", "tau_m", 0.2}),
                         [](const auto& param) { return param.param.name; });

// Gyro and accelerometer of the last link, three numbers each, alone.
class ImuGradientTest : public SmoothTest, public ::testing::WithParamInterface<Gradient> {};

TEST_P(ImuGradientTest, AgreesWithTightCentralDifferences) {
  CONTINUUM_LONG_IF_SANITIZED("a solver with tight tolerances");
  std::string model = SmoothArm(), outputs = "outputs:\n", experiment = testing::kSmoothExperiment;
  model.insert(model.find("</sensor>"), "<accelerometer name='acc' site='end'/>");
  for (int i = 0; i < 3; ++i)
    outputs += fmt::format(
        "  - {{column: g{0}, unit: rad/s, sensor: 'gyro[{0}]', sigma: 1}}\n"
        "  - {{column: a{0}, unit: m/s^2, sensor: 'acc[{0}]', sigma: 1}}\n",
        i);
  const std::size_t from = experiment.find("outputs:"), to = experiment.find("logs:");
  experiment.replace(from, to - from, outputs);
  Write("model.xml", model);
  std::string log, line;
  for (std::istringstream lines(SmoothLog(60)); std::getline(lines, line);)
    log += line + (log.empty() ? ",g0,g1,g2,a0,a1,a2\n" : ",0,0,0,0,0,0\n");
  Write("log.csv", log);
  const Experiment e = Experiment::Read(Write("e.yaml", experiment));
  EXPECT_LT(SlopeError(Slopes(e, GetParam()), CentralDifferences(e, GetParam())), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Attribute, ImuGradientTest,
                         ::testing::Values(Gradient{"Mass", "body:link1", "mass", 0.1},
                                           Gradient{"Stiffness", "joint:y*", "stiffness", 0.6},
                                           Gradient{"Lag", "actuator:lagged", "dynprm[0]", 0.04},
                                           Gradient{"Mount", "site:end", "pos[2]", -0.06},
                                           Gradient{"Body", "body:link2", "pos[2]", -0.1}),
                         [](const auto& param) { return param.param.name; });

// x(t) of m x'' = F − k x − c x' from rest, with F held: sensitivities in closed form.
TEST_F(SmoothTest, ResidualsHaveTheDerivativesOfTheClosedForm) {
  Write("model.xml",
        "<mujoco><option gravity='0 0 0'/><worldbody><body name='b'><joint name='x' type='slide' "
        "axis='1 0 0' stiffness='20' damping='0.8'/><inertial pos='0 0 0' mass='0.5' "
        "diaginertia='1 1 1'/></body></worldbody><actuator><motor name='f' joint='x'/></actuator>"
        "<sensor><jointpos name='x' joint='x'/></sensor></mujoco>");
  std::string csv = "time,u,x\n";
  for (int k = 0; k < 100; ++k) csv += fmt::format("{:.2f},3,0\n", 0.02 * k);
  Write("log.csv", csv);
  const Experiment e = Experiment::Read(
      Write("e.yaml",
            "format: 1\nmodel: model.xml\nstart: rest\n"
            "inputs: [{column: u, unit: N, actuator: f}]\n"
            "outputs: [{column: x, unit: m, sensor: x, sigma: 1}]\nlogs: [{file: log.csv}]\n"
            "parameters:\n"
            "  - {name: k, target: 'joint:x', attribute: stiffness, lower: 1, upper: 100}\n"
            "  - {name: c, target: 'joint:x', attribute: damping, lower: 0, upper: 10}\n"
            "  - {name: m, target: 'body:b', attribute: mass, lower: 0.1, upper: 2}\n"));
  const ModelSpec system = ModelSpec::Load(e.model);
  Problem problem(e, system);
  ASSERT_EQ(SmoothObstacle(problem), "");
  problem.Follow(Path::kSmooth);
  const Problem::Vector x = problem.Start();
  const auto r = problem.Residuals(x, problem.AllLogs());
  const auto J = problem.Jacobian(x, r, problem.AllLogs());
  const auto exact = [](double k, double c, double m, double t) {
    const double d = c / (2 * m), w = std::sqrt(k / m - d * d);
    return 3 / k * (1 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)));
  };
  for (int row = 0; row < 100; ++row) {
    const double t = 0.02 * row;
    EXPECT_NEAR(r[0][row], exact(x[0], x[1], x[2], t), 2e-6);
    for (int p = 0; p < 3; ++p) {
      const double step = 1e-5 * x[p];
      Problem::Vector more = x, less = x;
      more[p] += step, less[p] -= step;
      const double slope =
          (exact(more[0], more[1], more[2], t) - exact(less[0], less[1], less[2], t)) / (2 * step);
      EXPECT_NEAR(J[0](row, p) * x[p], slope * x[p], 5e-6) << "row " << row << " parameter " << p;
    }
  }
}

// Bristles and creep: states of ours beside those of MuJoCo. Their kinks at v = 0 cost steps.
TEST_F(SmoothTest, AgreesWithSmallStepsOfLawsWithStates) {
  const std::string bristles =
      Law("lugre",
          "<config key='joint' value='y1'/><config key='sigma_0' value='40'/>"
          "<config key='tau_c' value='0.02'/>");
  for (const std::string& law : {kCreep, bristles}) {
    const Experiment e = Read(SmoothArm(law));
    const ModelSpec system = ModelSpec::Load(e.model);
    ModelAndData machine = system.Build();
    machine.model->opt.timestep = 1e-5;
    const Trace steps = Simulate(machine, e, e.logs[0]);
    ContinuousDynamics dynamics(system.Build(), e, e.logs[0]);
    const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], {1e-8, 1e-10, false});
    EXPECT_LT(Apart(traces.trace, steps), 1e-3) << law;
  }
}

TEST_F(SmoothTest, RecoversWhatADifferentIntegratorSimulated) {
  const std::string parameters =
      "parameters:\n"
      "  - {name: k, target: 'joint:y*', attribute: stiffness, initial: 0.9, lower: 0.1, upper: "
      "3}\n"
      "  - {name: d, target: 'joint:x*', attribute: damping, initial: 0.01, lower: 0, upper: 1}\n"
      "  - {name: m, target: 'body:tip', attribute: mass, initial: 0.05, lower: 0.01, upper: 1}\n"
      "  - {name: bias, target: 'sensor:x0', attribute: bias, lower: -1, upper: 1}\n";
  Experiment e = Read(SmoothArm(), parameters);
  const ModelSpec system = ModelSpec::Load(e.model);
  ModelAndData machine = system.Build();
  machine.model->opt.integrator = mjINT_RK4;
  machine.model->opt.timestep = 1e-5;
  const Trace truth = Simulate(machine, e, e.logs[0]);
  for (std::size_t c = 0; c < truth.channel.size(); ++c) e.logs[0].measured[c] = truth.channel[c];
  for (double& v : e.logs[0].measured[0]) v += 0.05;
  Problem problem(e, system);
  problem.Follow(Path::kSmooth);
  const Fit fit = FitParameters(problem, problem.Start(), problem.AllLogs());
  EXPECT_TRUE(fit.converged) << fit.message;
  EXPECT_NEAR(fit.x[0], 0.6, 1e-3 * 0.6);
  EXPECT_NEAR(fit.x[1], 0.02, 1e-3 * 0.02);
  EXPECT_NEAR(fit.x[2], 0.03, 1e-3 * 0.03);
  EXPECT_NEAR(fit.x[3], 0.05, 1e-5);
}

struct Obstacle {
  std::string name, model, parameters, why;
};

void PrintTo(const Obstacle& o, std::ostream* out) { *out << o.name; }

class ObstacleTest : public SmoothTest, public ::testing::WithParamInterface<Obstacle> {};

TEST_P(ObstacleTest, IsNamed) {
  const Experiment e = Read(GetParam().model, GetParam().parameters);
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  EXPECT_THAT(SmoothObstacle(problem), HasSubstr(GetParam().why));
}

std::string Edited(std::string model, const std::string& from, const std::string& to) {
  return model.replace(model.find(from), from.size(), to);
}

INSTANTIATE_TEST_SUITE_P(
    Kind, ObstacleTest,
    ::testing::Values(
        Obstacle{"NativeFriction",
                 Edited(SmoothArm(), "armature='2e-4'", "armature='2e-4' frictionloss='0.1'"), "",
                 "'x0' has dry friction"},
        Obstacle{"FrictionThatAFitMayBring", SmoothArm(),
                 "parameters: [{name: f, target: 'joint:y1', attribute: frictionloss, initial: 0, "
                 "lower: 0, upper: 1}]\n",
                 "'y1' has dry friction"},
        Obstacle{"OurFrictionOfABall",
                 SmoothArm(Law("coulomb",
                               "<config key='joint' value='ball'/>"
                               "<config key='tau_c' value='0.1'/>")),
                 "", "has dry friction: it acts on a ball joint"},
        Obstacle{"CableWithALimit",
                 Edited(SmoothArm(Law("capstan",
                                      "<config key='tendon' value='ta'/>"
                                      "<config key='mu' value='0.1'/>")),
                        "name='ta'", "name='ta' limited='true' range='0 9'"),
                 "", "a cable whose friction is no bristle is under tension"},
        Obstacle{"SecondOrderLag",
                 SmoothArm(Law("pt2",
                               "<config key='actuator' value='pull'/>"
                               "<config key='w' value='20'/>")),
                 "", "has discrete states"},
        Obstacle{"Delay",
                 Edited(SmoothArm(), "name='pull'", "name='pull' delay='0.02' nsample='40'"), "",
                 "'pull' has a delay"},
        Obstacle{"Limit",
                 Edited(SmoothArm(), "armature='2e-4'",
                        "armature='2e-4' limited='true' range='-0.5 0.5'"),
                 "", "limit acts"}),
    [](const auto& param) { return param.param.name; });

TEST_F(SmoothTest, LooksAtHowOftenInputsBreak) {
  const Experiment e = Read(SmoothArm());
  const ModelSpec system = ModelSpec::Load(e.model);
  EXPECT_THAT(SmoothCost(Problem(e, system)), HasSubstr("of the rows"));
  EXPECT_TRUE(BreaksAt(e, e.logs[0], 0));
  Experiment held = e;
  held.inputs.pop_back();
  held.logs[0].input.pop_back();
  held.logs[0].enable.pop_back();
  EXPECT_TRUE(BreaksAt(held, held.logs[0], 5));
  EXPECT_FALSE(BreaksAt(held, held.logs[0], 6));
  EXPECT_EQ(SmoothCost(Problem(held, system)), "");
}

}  // namespace
}  // namespace continuum
