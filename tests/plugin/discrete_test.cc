// Under the discrete integrator MuJoCo has the rows of its solver once all forces are known. What
// memory held before must not matter.
#include <cmath>
#include <string>
#include <vector>

#include "support/engine.h"

namespace continuum {
namespace {

class Discrete : public testing::Engine {
 protected:
  // An arm of four links that its cables pull against a wall and a length limit.
  static testing::Owned<mjModel> Arm(const std::string& extension) {
    std::string links, close, left, right;
    for (int k = 0; k < 4; ++k) {
      const std::string n = std::to_string(k);
      links += "<body pos='0 0 " + std::string(k ? ".1" : ".5") + "'><joint name='j" + n +
               "' axis='0 1 0' stiffness='.3' damping='.02' armature='.001'/><geom type='capsule' "
               "size='.02' fromto='0 0 0 0 0 .08' mass='.1'/><site name='l" +
               n + "' pos='.03 0 .05'/><site name='r" + n + "' pos='-.03 0 .05'/>";
      close += "</body>";
      left += "<site site='l" + n + "'/>", right += "<site site='r" + n + "'/>";
    }
    return Model(
        "<mujoco><option integrator='discrete' timestep='2e-3'/>" + extension +
        "<worldbody><geom type='box' size='.05 1 1' pos='.15 0 1'/><site name='a' pos='.03 "
        "0 .45'/><site name='b' pos='-.03 0 .45'/>" +
        links + close + "</worldbody><tendon><spatial name='c1'><site site='a'/>" + left +
        "</spatial><spatial name='c2' limited='true' range='0 .415'><site site='b'/>" + right +
        "</spatial></tendon><actuator><motor tendon='c1' gear='-1'/></actuator></mujoco>");
  }
};

TEST_F(Discrete, StepsFromARestoredStateBitByBit) {
  for (const std::string& extension :
       {Instance("capstan", Key("tendon", "c*") + Key("mu", ".2")),
        Instance("coulomb", Key("joint", "j*") + Key("tau_c", ".02"))}) {
    const auto m = Arm(extension);
    const auto run = [&](mjData* d, int steps) {
      int rows = 0;
      for (int k = 0; k < steps; ++k) {
        d->ctrl[0] = 8 + 6 * std::sin(8 * d->time);
        mj_step(m.get(), d);
        rows = std::max(rows, d->nefc - d->nf);
      }
      return rows;
    };
    const auto d = Data(m);
    run(d.get(), 300);
    const auto saved = State(m, d);
    ASSERT_GT(run(d.get(), 300), 2);  // the limit and a contact
    const auto ended = State(m, d);
    for (int k = 0; k < 4; ++k) {
      const auto other = Data(m);
      run(other.get(), 37 * k);
      mj_setState(m.get(), other.get(), saved.data(), mjSTATE_INTEGRATION);
      run(other.get(), 300);
      EXPECT_EQ(State(m, other), ended) << extension << ", " << k;
    }
  }
}

}  // namespace
}  // namespace continuum
