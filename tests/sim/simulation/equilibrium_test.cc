#include "sim/simulation/equilibrium.h"

#include <gtest/gtest.h>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// A platform on two cables that winches wind up, which can only pull: near the lengths of the first
// row it hangs, at a quarter of them it is not where it was made.
constexpr char kWinches[] = R"(<mujoco><worldbody>
  <site name="a0" pos="-.6 0 0"/><site name="a1" pos=".6 0 0"/>
  <body pos="0 0 -.5"><joint name="x" type="slide" axis="1 0 0"/>
    <joint name="z" type="slide" axis="0 0 1"/>
    <geom type="box" size=".05 .04 .02" mass="2.5"/><site name="hook"/></body></worldbody>
  <tendon><spatial name="c0"><site site="a0"/><site site="hook"/></spatial>
    <spatial name="c1"><site site="a1"/><site site="hook"/></spatial></tendon>
  <actuator><position name="w0" tendon="c0" kp="5000" forcerange="-2000 0"/>
    <position name="w1" tendon="c1" kp="5000" forcerange="-2000 0"/></actuator></mujoco>)";

struct Hanging {
  ModelSpec model = ModelSpec::Parse(kWinches);
  Experiment experiment;
  Log log;

  Hanging(double left, double right) {
    for (const char* const name : {"w0", "w1"}) {
      Input in;
      in.column = in.actuator = name;
      experiment.inputs.push_back(in);
    }
    log.label = "a";
    log.time = {0, 0.1};
    log.input = {{left, left}, {right, right}};
    log.enable.resize(2);
  }
};

TEST(Equilibrium, IsFoundWhereInputsAreLengthsAndCablesOnlyPull) {
  for (const auto& [left, right] :
       {std::pair{0.78, 0.78}, std::pair{0.6, 0.95}, std::pair{0.9, 0.5}, std::pair{1.3, 0.4}}) {
    const Hanging h(left, right);
    ModelAndData machine = h.model.Build({});
    const InitialState rest = Equilibrium(machine, h.experiment, h.log);
    mjData& d = *machine.data;
    std::copy(rest.qpos.begin(), rest.qpos.end(), d.qpos);
    d.ctrl[0] = left, d.ctrl[1] = right;
    mj_forward(machine.model.get(), &d);
    EXPECT_NEAR(d.qacc[0], 0, 1e-6) << left << ' ' << right;
    EXPECT_NEAR(d.qacc[1], 0, 1e-6) << left << ' ' << right;
    EXPECT_LT(d.qpos[1], 0.5) << "hangs below its cables' ends";
  }
}

}  // namespace
}  // namespace continuum
