// Inverse dynamics of cables whose tension comes from rows of the constraint solver.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "support/engine.h"

namespace continuum {
namespace {

class CableInverse : public testing::Engine {
 protected:
  // Two arms of two links, each with a cable over two contacts; the motor pulls the first cable,
  // and `tie` joins it to the second.
  static testing::Owned<mjModel> Arms(const std::string& range, const std::string& tie) {
    const auto arm = [](const std::string& n, const std::string& y) {
      return "<site name='o" + n + "' pos='-.05 " + y + " .02'/><body name='a" + n + "' pos='0 " +
             y + R"( 0'><joint name='j)" + n + R"(' axis='0 1 0' stiffness='.5' damping='.02'/>
          <geom type='capsule' fromto='0 0 0 .1 0 0' size='.01' mass='.05' contype='0'/>
          <site name='p)" +
             n + R"(' pos='.05 0 .02'/><body name='b)" + n + R"(' pos='.1 0 0'>
          <joint name='k)" +
             n + R"(' axis='0 1 0' stiffness='.5' damping='.02'/>
          <geom type='capsule' fromto='0 0 0 .1 0 0' size='.01' mass='.05' contype='0'/>
          <site name='q)" +
             n + R"(' pos='.03 0 .02'/><site name='r)" + n + R"(' pos='.08 0 .02'/>
          </body></body>)";
    };
    const auto route = [](const std::string& n) {
      return "<site site='o" + n + "'/><site site='p" + n + "'/><site site='q" + n +
             "'/><site site='r" + n + "'/></spatial>";
    };
    auto [m, error] =
        Compile("<mujoco><option timestep='.001' integrator='implicitfast' tolerance='0'/>" +
                Instance("capstan", Key("tendon", "*") + Key("mu", ".5")) + "<worldbody>" +
                arm("0", "0") + arm("1", ".3") + "</worldbody><tendon><spatial name='t0' " + range +
                ">" + route("0") + "<spatial name='t1'>" + route("1") + "</tendon>" + tie +
                "<actuator><motor tendon='t0' gear='-1'/></actuator></mujoco>");
    EXPECT_TRUE(m) << error;
    return std::move(m);
  }

  // Largest generalized force [N m] that mj_inverse misses, while the motor pulls with f, and the
  // largest share of friction in that time.
  static std::pair<double, double> Missed(const testing::Owned<mjModel>& m, double f) {
    const auto d = Data(m);
    double most = 0, friction = 0;
    for (int k = 0; k < 300; ++k) {
      d->ctrl[0] = f * (k % 100 < 50 ? 1 : .3);
      mj_step(m.get(), d.get());
      mj_forward(m.get(), d.get());
      mj_inverse(m.get(), d.get());
      for (int i = 0; i < m->nv; ++i) {
        most = std::max(most, std::abs(d->qfrc_inverse[i] - d->qfrc_actuator[i]));
        friction = std::max(friction,
                            std::abs(d->qfrc_passive[i] - d->qfrc_spring[i] - d->qfrc_damper[i]));
      }
    }
    return {most, friction};
  }
};

// The tension is what the constraint gave in mj_forward, not that of the step before.
TEST_F(CableInverse, AgreesWithForwardDynamicsWhereAnEqualityOrALimitPulls) {
  const std::string tie = "<equality><tendon tendon1='t0' tendon2='t1'/></equality>";
  for (const auto& [range, equality, pull] : {std::tuple{"", tie, 10.},
                                              {"limited='true' range='0 .13'", "", 0.},
                                              {"limited='true' range='0 .13'", "", -3.},
                                              {"", "", 10.}}) {
    const auto m = Arms(range, equality);
    ASSERT_TRUE(m);
    const auto [missed, friction] = Missed(m, pull);
    EXPECT_LT(missed, 1e-9) << range << equality;  // rounding, and the end of the solver
    EXPECT_GT(friction, 1e-3) << range << equality;
  }
}

}  // namespace
}  // namespace continuum
