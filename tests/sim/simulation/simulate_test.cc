#include "sim/simulation/simulate.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

// A mass on a slide; the servo's force and the position are measured every period.
class Slider : public ::testing::Test {
 protected:
  struct Trial {
    Experiment experiment;
    ModelAndData machine;
  };

  Trial Read(const std::string& option, const std::string& actuator, double period, int rows,
             const std::string& start = "rest") const {
    scratch_.Write("m.xml", fmt::format(R"(<mujoco>
  <option {}/>
  <worldbody><body><joint name="x" type="slide" axis="1 0 0"/><geom size="0.1" mass="1"/></body></worldbody>
  <actuator>{}</actuator>
  <sensor><jointpos name="x" joint="x"/><actuatorfrc name="f" actuator="a"/></sensor>
</mujoco>
)",
                                        option, actuator));
    std::string log = "time,u,x,f\n";
    for (int k = 0; k < rows; ++k) log += fmt::format("{},{},0,0\n", k * period, k ? 2 : 1);
    scratch_.Write("log.csv", log);
    Trial trial;
    trial.experiment = Experiment::Read(scratch_.Write(
        "e.yaml",
        "format: 1\nmodel: m.xml\nstart: " + start +
            "\ninputs: [{column: u, unit: N, actuator: a}]\n"
            "outputs: [{column: x, unit: m, sensor: x},\n"
            "  {column: f, unit: N, actuator: a, quantity: force}]\nlogs: [{file: log.csv}]\n"));
    trial.machine = ModelSpec::Load(trial.experiment.model).Build();
    return trial;
  }

  testing::Scratch scratch_;
};

TEST_F(Slider, RecordsTheForceOfTheRowUnderEveryIntegrator) {
  for (const std::string integrator : {"Euler", "RK4", "implicit", "implicitfast"}) {
    auto [e, machine] = Read(fmt::format("timestep=\"0.01\" integrator=\"{}\"", integrator),
                             "<position name=\"a\" joint=\"x\" kp=\"100\"/>", 0.01, 20);
    const Trace trace = Simulate(machine, e, e.logs[0]);
    for (std::size_t k = 0; k < 20; ++k) {
      const double expected = 100 * (e.logs[0].input[0][k] - trace.channel[0][k]);
      EXPECT_NEAR(trace.channel[1][k], expected, 1e-9) << integrator << " row " << k;
    }
  }
}

TEST_F(Slider, HooksSeeTheStateOfTheirRow) {
  for (const std::string integrator : {"Euler", "RK4"}) {
    auto [e, machine] = Read(fmt::format("timestep=\"0.01\" integrator=\"{}\"", integrator),
                             "<motor name=\"a\" joint=\"x\"/>", 0.02, 10);
    std::vector<double> seen;
    Hooks hooks;
    hooks.row = [&](const mjModel&, mjData& d, std::size_t row) {
      EXPECT_EQ(row, seen.size());
      EXPECT_EQ(d.qpos[0], d.sensordata[0]) << integrator << " row " << row;
      seen.push_back(d.qpos[0]);
    };
    const Trace trace = Simulate(machine, e, e.logs[0], {}, hooks);
    EXPECT_EQ(trace.channel[0], seen);
    auto [again, other] = Read(fmt::format("timestep=\"0.01\" integrator=\"{}\"", integrator),
                               "<motor name=\"a\" joint=\"x\"/>", 0.02, 10);
    EXPECT_EQ(Simulate(other, again, again.logs[0]).channel, trace.channel);
  }
}

// Sensors between rows and a solver without rows are left out: the steps are the same to the bit.
TEST_F(Slider, StepsAsMujocoDoes) {
  for (const std::string integrator : {"Euler", "RK4", "implicit", "implicitfast"}) {
    auto [e, machine] = Read(fmt::format("timestep=\"0.01\" integrator=\"{}\"", integrator),
                             "<position name=\"a\" joint=\"x\" kp=\"100\"/>", 0.05, 20);
    for (const int touches : {0, 1}) {
      mjModel& m = *machine.model;
      mjData& d = *machine.data;
      m.geom_contype[0] = m.geom_conaffinity[0] = touches;
      const int flags = m.opt.disableflags | mjDSBL_AUTORESET;
      const Trace trace = Simulate(machine, e, e.logs[0]);
      EXPECT_EQ(m.opt.disableflags, flags);
      mj_resetData(&m, &d);
      for (std::size_t row = 0; row < 20; ++row) {
        d.ctrl[0] = e.logs[0].input[0][row];
        EXPECT_EQ(trace.channel[0][row], d.qpos[0]) << integrator << " row " << row;
        for (int step = 0; step < 5; ++step) mj_step(&m, &d);
      }
    }
  }
}

TEST_F(Slider, LagsSettleWithinTheRangesOfTheirActuator) {
  auto [e, machine] = Read("timestep=\"0.01\"",
                           "<general name=\"a\" joint=\"x\" dyntype=\"filterexact\" dynprm=\"10\" "
                           "ctrllimited=\"true\" ctrlrange=\"-0.5 0.5\" actlimited=\"true\" "
                           "actrange=\"-0.3 0.3\"/>",
                           0.01, 3);
  EXPECT_NEAR(Simulate(machine, e, e.logs[0]).channel[1][0], 0.3, 1e-12);
}

TEST_F(Slider, ADelayHoldsWhereRowsAreDenserThanSteps) {
  // The input steps at 0.2 ms; the force follows 50 ms later, whatever the rows are.
  auto [e, machine] = Read("timestep=\"0.001\"",
                           "<motor name=\"a\" joint=\"x\" delay=\"0.05\" nsample=\"2\" "
                           "interp=\"zoh\"/>",
                           0.0002, 400);
  const Trace trace = Simulate(machine, e, e.logs[0]);
  for (std::size_t k = 0; k < 400; ++k) {
    const double t = e.logs[0].time[k];
    if (t > 0.049 && t < 0.052) continue;
    EXPECT_EQ(trace.channel[1][k], t < 0.05 ? 1 : 2) << t;
  }
}

TEST_F(Slider, ADelayThatNoHistoryCoversIsNamed) {
  auto [e, machine] =
      Read("timestep=\"0.01\"", "<motor name=\"a\" joint=\"x\" delay=\"0.05\" nsample=\"2\"/>",
           0.0002, 400);
  try {
    Simulate(machine, e, e.logs[0]);
    FAIL() << "nothing was said";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("actuator 'a' with a delay of 0.05 s"));
  }
}

}  // namespace
}  // namespace continuum
