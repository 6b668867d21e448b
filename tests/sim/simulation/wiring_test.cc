#include "sim/simulation/simulate.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr char kArm[] = R"(<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body name="arm">
      <joint name="hinge" axis="0 1 0"/>
      <geom size="0.1" mass="1"/>
    </body>
  </worldbody>
  <sensor>
    <framequat name="turn" objtype="body" objname="arm"/>
    <framexaxis name="x" objtype="body" objname="arm"/>
    <jointpos name="angle" joint="hinge"/>
    <user name="many" dim="12"/>
  </sensor>
</mujoco>)";

class SimulatedArm : public ::testing::Test {
 protected:
  SimulatedArm() : system_(ModelSpec::Load(scratch_.Write("arm.xml", kArm))) {
    log_.label = "log";
    log_.time = {0, 0.01};
  }
  void AddOutput(const std::string& sensor, const std::vector<std::string>& columns = {"y"}) {
    Output out;
    out.columns = columns;
    out.unit = "1";
    out.source = sensor;
    out.where = "e.yaml:5: outputs[0]";
    for (std::size_t c = 0; c < columns.size(); ++c)
      e_.channels.push_back({columns[c], "1", e_.outputs.size(), c, 1});
    e_.outputs.push_back(out);
  }
  std::string Refusal(const std::string& sensor, double angle = 0) {
    AddOutput(sensor);
    e_.outputs.back().measurement.angle = angle;
    try {
      const Wiring wiring(e_, system_.model());
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }

  testing::Scratch scratch_;
  ModelSpec system_;
  Experiment e_;
  Log log_;
};

// y_meas = R(axis, angle) y, for vectors and for orientations.
TEST_F(SimulatedArm, IsMeasuredInATurnedFrame) {
  AddOutput("turn", {"w", "x", "y", "z"});
  AddOutput("x[1]");
  for (Output& out : e_.outputs) out.measurement.angle = 0.2, out.measurement.axis = {0, 0, 2};
  ModelAndData machine = system_.Build();
  const Trace trace = Simulate(machine, e_, log_, {{0.3}, {0}});
  double arm[4], frame[4], expected[4];
  const double y[3] = {0, 1, 0}, z[3] = {0, 0, 1}, ahead[3] = {1, 0, 0};
  mju_axisAngle2Quat(arm, y, 0.3);
  mju_axisAngle2Quat(frame, z, 0.2);
  mju_mulQuat(expected, frame, arm);
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(trace.channel[c][0], expected[c], 1e-14);
  double x[3];
  mju_rotVecQuat(x, ahead, expected);
  EXPECT_NEAR(trace.channel[4][0], x[1], 1e-14);
}

// Between the rows no line is drawn: its error is T² ω²/8, here 0.005.
TEST_F(SimulatedArm, IsMeasuredLateAlsoBetweenItsRows) {
  constexpr double kOmega = 20, kDelay = 0.0037;
  AddOutput("angle");
  e_.outputs.back().measurement.delay = kDelay;
  Trace trace;
  trace.raw = {{{}}};
  log_.time.clear();
  for (int k = 0; k < 100; ++k) {
    log_.time.push_back(0.01 * k + 0.002 * (k % 2));
    trace.raw[0][0].push_back(std::sin(kOmega * log_.time.back()));
  }
  MeasureTrace(e_, Wiring(e_, system_.model()), log_, trace);
  EXPECT_EQ(trace.channel[0][0], 0);  // held at the start
  for (int k = 2; k < 98; ++k)
    EXPECT_NEAR(trace.channel[0][k], std::sin(kOmega * (log_.time[k] - kDelay)), 3e-4) << k;
}

TEST_F(SimulatedArm, HasNoDirectionInASensorOfOneNumber) {
  EXPECT_THAT(Refusal("angle", 0.1),
              AllOf(HasSubstr("e.yaml:5: outputs[0].angle"), HasSubstr("'angle' with 1 number")));
}

TEST_F(SimulatedArm, NamesComponentsBeyondTheNinth) {
  AddOutput("many[11]");
  EXPECT_EQ(Wiring(e_, system_.model()).output[0].component, 11);
  EXPECT_THAT(Refusal("many[12]"), AllOf(HasSubstr("below 12"), HasSubstr("found 12")));
  for (const char* wrong : {"many[]", "many[-1]", "many[+1]", "many[1x]", "many[1", "[1]", "["}) {
    e_ = {};
    EXPECT_THAT(Refusal(wrong), AllOf(HasSubstr(wrong), HasSubstr("a sensor of the model")));
  }
}

TEST_F(SimulatedArm, RefusesLogsWithoutEnd) {
  AddOutput("angle");
  ModelAndData machine = system_.Build();
  log_.time.back() = 1e12;
  EXPECT_THROW(Simulate(machine, e_, log_), Error);
}

}  // namespace
}  // namespace continuum
