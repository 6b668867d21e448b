// A cable around a bend so sharp that Coulomb friction on the normal force locks it: t = mu
// tan(θ/2) reaches 1 at 126.87 degrees for mu = 0.5.
#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kMu = 0.5, kWeight = 9.81;

class Locking : public testing::Engine, public ::testing::WithParamInterface<int> {
 protected:
  // A load of 1 kg hangs on a cable that comes to it around a bend of `degrees`.
  static testing::Owned<mjModel> Hoist(int degrees, double h = 1e-3,
                                       const std::string& integrator = "implicitfast") {
    const double theta = degrees * M_PI / 180;
    auto m = Model(
        "<mujoco><option integrator=\"" + integrator + "\"/>" +
        Instance("capstan", Key("tendon", "cable") + Key("mu", "0.5") + Key("law", "coulomb")) +
        "<worldbody><site name=\"a\" pos=\"" + std::to_string(0.1 * std::sin(theta)) + " 0 " +
        std::to_string(0.5 + 0.1 * std::cos(theta)) + "\"/>" +
        R"(<site name="b" pos="0 0 .5"/><body><joint name="z" type="slide" axis="0 0 1"/>
           <inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/><site name="e"/></body></worldbody>
         <tendon><spatial name="cable"><site site="a"/><site site="b"/><site site="e"/></spatial></tendon>
         <actuator><motor tendon="cable" gear="-1"/></actuator>
         <sensor><plugin plugin="continuum.capstan" instance="i" objtype="site" objname="b"/></sensor>
         </mujoco>)");
    m->opt.timestep = h;
    return m;
  }
};
INSTANTIATE_TEST_SUITE_P(Degrees, Locking, ::testing::Values(126, 128, 150));

TEST_P(Locking, APulledCableHandsOnTheLittleThatTheLawLeaves) {
  const auto m = Hoist(GetParam());
  const auto d = Data(m);
  d->ctrl[0] = 10, d->qvel[0] = 0.1;
  mj_forward(m.get(), d.get());
  // The sites are written to 1e-6 m of 0.1 m: 2e-5 rad, at most 6.3 N/rad.
  const double t = kMu * std::tan(GetParam() * M_PI / 360);
  EXPECT_NEAR(d->sensordata[0], t < 1 ? 10 * (1 - t) / (1 + t) : 0, 1e-4);
}

// Friction takes energy only: the load's, less what the constant base tension draws in, never
// grows. The first step alone may lift it, while gravity acts at the old position: (g h)²/2 = 2e-4
// J.
TEST_P(Locking, AFallingLoadIsCaughtWithoutBeingThrownBack) {
  for (const char* integrator : {"Euler", "RK4", "implicitfast"}) {
    for (const double h : {5e-4, 1e-3, 2e-3}) {
      const auto m = Hoist(GetParam(), h, integrator);
      const auto d = Data(m);
      d->ctrl[0] = 1;
      mj_step(m.get(), d.get());  // fresh data would give the law at the first speed
      d->qvel[0] = -0.1, d->qpos[0] = 0;
      const auto energy = [&] {
        return 0.5 * d->qvel[0] * d->qvel[0] + (kWeight - 1) * d->qpos[0];
      };
      const double start = energy();
      double highest = start;
      while (d->time < 0.5) {
        mj_step(m.get(), d.get());
        ASSERT_TRUE(std::isfinite(d->qpos[0]));
        highest = std::max(highest, energy());
      }
      EXPECT_LT(highest, start + 2e-4) << integrator << h;
      EXPECT_GT(d->qpos[0], -5e-3) << integrator << h;
      const double held = d->qpos[0];
      RunUntil(m, d, 5.5);
      EXPECT_NEAR(d->qpos[0], held, 1e-6) << integrator << h;
      EXPECT_NEAR(d->sensordata[0], kWeight, 1e-6) << integrator << h;
    }
  }
}

TEST_P(Locking, AHeldLoadStaysWhenTheBaseTensionRisesOrFalls) {
  const auto m = Hoist(GetParam());
  const auto d = Data(m);
  d->ctrl[0] = 1;
  RunUntil(m, d, 1);
  const double start = d->qpos[0];
  double fastest = 0;
  for (const double base : {5.0, 0.5, 50.0, 1.0}) {
    d->ctrl[0] = base;
    for (const double end = d->time + 0.5; d->time < end;) {
      mj_step(m.get(), d.get());
      fastest = std::max(fastest, std::abs(d->qvel[0]));
    }
  }
  // A tension that falls lets the load fall until the spring of (4) has it: 1e-4 m, 0.012 m/s.
  EXPECT_LT(fastest, 0.02);
  EXPECT_NEAR(d->qpos[0], start, 5e-4);
  const double settled = d->qpos[0];
  RunUntil(m, d, 8);
  EXPECT_NEAR(d->qpos[0], settled, 1e-6);
}

}  // namespace
}  // namespace continuum
