#include "sim/model/joint_equalities.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gradient.h"
#include "identification/problem/path_choice.h"
#include "sim/simulation/simulate.h"
#include "smooth_arm.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Apart;
using ::testing::HasSubstr;
using testing::kSmoothExperiment;
using testing::SmoothArm;
using testing::SmoothLog;

class TiesTest : public testing::Bench {
 protected:
  Experiment Read(const std::string& model, int rows = 60) const {
    Write("model.xml", model);
    Write("log.csv", SmoothLog(rows));
    return Experiment::Read(Write("e.yaml", kSmoothExperiment));
  }
  // The published actuator hanging under two pressures that step, beside all its sensors.
  Experiment Actuator() const {
    std::string csv = "time,p1,p2,x,y,z,fx,fz,tx,ty,dx,dl\n";
    for (int k = 0; k < 60; ++k)
      csv += fmt::format("{:.3f},{},{},0,0,0,0,0,0,0,0,0\n", 0.005 * k, k < 4 ? 0 : 40e3,
                         k < 24 ? 0 : 25e3);
    Write("log.csv", csv);
    std::string outputs;
    for (const auto& [column, unit, sensor] : {std::array{"x", "m", "tip_pos[0]"},
                                               {"y", "m", "tip_pos[1]"},
                                               {"z", "m", "tip_pos[2]"},
                                               {"fx", "N", "base_force[0]"},
                                               {"fz", "N", "base_force[2]"},
                                               {"tx", "N*m", "base_torque[0]"},
                                               {"ty", "N*m", "base_torque[1]"},
                                               {"dx", "m", "delta[0]"},
                                               {"dl", "m", "delta[2]"}}) {
      outputs += fmt::format("  - {{column: {}, unit: {}, sensor: \"{}\", sigma: 1}}\n", column,
                             unit, sensor);
    }
    return Experiment::Read(
        Write("e.yaml",
              "format: 1\nmodel: " CONTINUUM_SOURCE "/models/spa/spa.xml\nstart: rest\ninputs:\n"
              "  - {column: p1, unit: Pa, actuator: p1}\n  - {column: p2, unit: Pa, actuator: p2}\n"
              "outputs:\n" +
                  outputs + "logs: [{file: log.csv}]\n"));
  }
};

std::string Tied(const std::string& equalities, std::string model = SmoothArm()) {
  return model.insert(model.find("<sensor>"), "<equality>" + equalities + "</equality>");
}

constexpr const char* kStiff = " solref='1e-4' solimp='0.9999 0.9999'/>";

// With x = 0.2 + (y − 0.3)/2 + 0.05,
//
//   (m_y + m_x/4) y'' = F_y + F_x/2 − k (x − x_0)/2 − c y'
//
// from rest, with F held: a damped oscillation in closed form.
TEST_F(TiesTest, TwoJointsMoveByTheClosedForm) {
  Write("model.xml",
        "<mujoco><option gravity='0 0 0'/><worldbody>"
        "<body><joint name='x' type='slide' axis='1 0 0' ref='0.2' stiffness='80' springref='0.2'/>"
        "<inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/></body>"
        "<body><joint name='y' type='slide' axis='1 0 0' ref='0.3' damping='0.8'/>"
        "<inertial pos='0 0 0' mass='0.5' diaginertia='1 1 1'/></body></worldbody>"
        "<equality><joint joint1='x' joint2='y' polycoef='0.05 0.5 0 0 0'/></equality>"
        "<actuator><motor name='fx' joint='x'/><motor name='fy' joint='y'/></actuator>"
        "<sensor><jointpos name='x' joint='x'/><jointpos name='y' joint='y'/></sensor></mujoco>");
  std::string csv = "time,a,b,x,y\n";
  for (int k = 0; k < 100; ++k) csv += fmt::format("{:.2f},3,1,0,0\n", 0.02 * k);
  Write("log.csv", csv);
  const Experiment e = Experiment::Read(
      Write("e.yaml",
            "format: 1\nmodel: model.xml\nstart: rest\ninputs:\n"
            "  - {column: a, unit: N, actuator: fx}\n  - {column: b, unit: N, actuator: fy}\n"
            "outputs:\n  - {column: x, unit: m, sensor: x, sigma: 1}\n"
            "  - {column: y, unit: m, sensor: y, sigma: 1}\nlogs: [{file: log.csv}]\n"));
  ContinuousDynamics dynamics(ModelSpec::Load(e.model).Build(), e, e.logs[0]);
  EXPECT_EQ(dynamics.size(), 2U);
  const Trace trace = SimulateSmooth(dynamics, {}, e, e.logs[0], {1e-10, 1e-12, false}).trace;
  const double m = 0.5 + 2 / 4.0, k = 80 / 4.0, c = 0.8, force = 1 + 3 / 2.0 - 80 * 0.05 / 2;
  const double d = c / (2 * m), w = std::sqrt(k / m - d * d);
  for (int row = 0; row < 100; ++row) {
    const double t = 0.02 * row;
    const double y =
        force / k * (1 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)));
    EXPECT_NEAR(trace.channel[1][row], 0.3 + y, 1e-8) << t;
    EXPECT_NEAR(trace.channel[0][row], 0.25 + y / 2, 1e-8) << t;
  }
}

// Between and beyond the ties: free joints, a ball joint, cables, lags. MuJoCo holds its equalities
// to some 1e-5 and its inputs half a step late.
TEST_F(TiesTest, ATiedArmAgreesWithSmallStepsOfMuJoCo) {
  const Experiment e =
      Read(Tied(fmt::format("<joint joint1='x1' joint2='x0' polycoef='0 0.5 0 0 0'{0}"
                            "<joint joint1='x2' joint2='x1' polycoef='0 -0.8 0 0 0'{0}"
                            "<joint joint1='y1' joint2='y2'{0}",
                            kStiff)));
  const ModelSpec system = ModelSpec::Load(e.model);
  ModelAndData machine = system.Build();
  machine.model->opt.integrator = mjINT_RK4;
  machine.model->opt.timestep = 5e-6;
  const Trace steps = Simulate(machine, e, e.logs[0]);
  for (const bool stiff : {false, true}) {
    ContinuousDynamics dynamics(system.Build(), e, e.logs[0]);
    const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], {1e-8, 1e-10, stiff});
    ASSERT_FALSE(traces.trace.diverged) << traces.trace.Failure();
    EXPECT_LT(Apart(traces.trace, steps), 2e-4) << (stiff ? "BDF" : "Adams");
  }
}

// 33 joints of which 3 are free. Fine steps: the pressures' lag half a step late, of 7 ms.
TEST_F(TiesTest, TheActuatorAgreesWithSmallStepsOfMuJoCo) {
  const Experiment e = Actuator();
  const ModelSpec system = ModelSpec::Load(e.model);
  ModelAndData machine = system.Build();
  machine.model->opt.integrator = mjINT_RK4;
  machine.model->opt.timestep = 2e-5;
  const Trace steps = Simulate(machine, e, e.logs[0]);
  ContinuousDynamics dynamics(system.Build(), e, e.logs[0]);
  EXPECT_EQ(dynamics.size(), 3U + 3U + 3U);
  const SmoothTraces traces = SimulateSmooth(dynamics, {}, e, e.logs[0], {1e-8, 1e-10, false});
  ASSERT_FALSE(traces.trace.diverged) << traces.trace.Failure();
  EXPECT_LT(Apart(traces.trace, steps), 1e-3);
}

class TiedGradientTest : public TiesTest,
                         public ::testing::WithParamInterface<testing::Gradient> {};

TEST_P(TiedGradientTest, AgreesWithTightCentralDifferences) {
  const Experiment e = Actuator();
  EXPECT_LT(testing::SlopeError(testing::Slopes(e, GetParam()),
                                testing::CentralDifferences(e, GetParam())),
            1e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Attribute, TiedGradientTest,
    ::testing::Values(testing::Gradient{"Stiffness", "plugin:segment", "k_theta", 183.5195},
                      testing::Gradient{"Damping", "plugin:segment", "d_theta", 0.2301},
                      testing::Gradient{"Chamber", "plugin:segment", "A", 3.1e-5},
                      testing::Gradient{"Mass", "body:link5", "mass", 0.02408},
                      testing::Gradient{"Gain", "actuator:p1", "gainprm[0]", 1},
                      testing::Gradient{"Gravity", "option", "gravity[2]", -9.81}),
    [](const auto& param) { return param.param.name; });

struct Refusal {
  std::string name, equalities, why;
};

void PrintTo(const Refusal& r, std::ostream* out) { *out << r.name; }

class TiedObstacleTest : public TiesTest, public ::testing::WithParamInterface<Refusal> {};

TEST_P(TiedObstacleTest, IsNamed) {
  const Experiment e = Read(Tied(GetParam().equalities));
  const ModelSpec system = ModelSpec::Load(e.model);
  const std::string why = SmoothObstacle(Problem(e, system));
  if (GetParam().why.empty()) {
    EXPECT_EQ(why, "");
  } else {
    EXPECT_THAT(why, HasSubstr(GetParam().why));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kind, TiedObstacleTest,
    ::testing::Values(
        Refusal{"Quadratic", "<joint name='e' joint1='x1' joint2='x0' polycoef='0 1 0.2 0 0'/>",
                "equality 'e' is not linear"},
        Refusal{"Connect", "<connect name='e' body1='link2' anchor='0 0 0'/>",
                "equality 'e' ties no joints"},
        Refusal{"Cable", "<tendon name='e' tendon1='ta'/>", "equality 'e' ties no joints"},
        Refusal{"Contradiction",
                "<joint joint1='x1' joint2='x0'/><joint joint1='x2' joint2='x1'/>"
                "<joint name='e' joint1='x0' joint2='x2' polycoef='0.1 1 0 0 0'/>",
                "equality 'e' contradicts others"},
        Refusal{"TwiceTheSame",
                "<joint joint1='x1' joint2='x0'/><joint joint1='x2' joint2='x1'/>"
                "<joint joint1='x0' joint2='x2'/>",
                ""},
        Refusal{"ACircleAsItIsWritten",
                "<joint joint1='x1' joint2='x0' polycoef='0 0.333333 0 0 0'/>"
                "<joint joint1='x0' joint2='x1' polycoef='0 3 0 0 0'/>",
                ""},
        Refusal{"Off", "<connect name='e' active='false' body1='link2' anchor='0 0 0'/>", ""}),
    [](const auto& param) { return param.param.name; });

TEST_F(TiesTest, AModelOfWhichNothingIsFreeIsAnObstacle) {
  const auto file = Write(
      "held.xml",
      "<mujoco><worldbody><body><joint name='x' type='slide'/><geom size='.1'/></body></worldbody>"
      "<equality><joint joint1='x'/></equality></mujoco>");
  EXPECT_THAT(JointEqualities(ModelSpec::Load(file).model()).obstacle(),
              HasSubstr("hold every joint"));
}

// Joints that nothing else but equalities say where they are.
TEST_F(TiesTest, JointsMayBeHeld) {
  const Experiment e =
      Read(Tied("<joint joint1='x1' polycoef='0.3 0 0 0 0'/><joint joint1='x1' joint2='x2'/>"
                "<joint joint1='y0' joint2='y1' polycoef='0.1 1 0 0 0'/>"
                "<joint joint1='y0' joint2='y1' polycoef='0.2 2 0 0 0'/>"));
  const ModelAndData machine = ModelSpec::Load(e.model).Build();
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  JointEqualities ties(m);
  ASSERT_EQ(ties.obstacle(), "");
  ASSERT_EQ(ties.velocities(), 5U);  // x0, y2, ball
  ASSERT_EQ(ties.positions(), 6U);
  const std::vector<double> q{0.5, -0.5, 1, 0, 0, 0}, v{2, -2, 0.1, 0.2, 0.3};
  ties.Spread(m, q.data(), v.data(), d);
  const std::vector<double> qpos(d.qpos, d.qpos + m.nq), qvel(d.qvel, d.qvel + m.nv);
  const auto near = [](double x) { return ::testing::DoubleNear(x, 1e-12); };
  EXPECT_THAT(qpos, ::testing::ElementsAre(near(0.5), near(0), near(0.3), near(-0.1), near(0.3),
                                           near(-0.5), 1, 0, 0, 0));
  EXPECT_THAT(qvel, ::testing::ElementsAre(2, 0, 0, 0, 0, -2, 0.1, 0.2, 0.3));
}

}  // namespace
}  // namespace continuum
