#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kPlus = 0.06, kMinus = 0.03, kInertia = 0.02;

class Directional : public testing::Engine, public ::testing::WithParamInterface<const char*> {
 protected:
  static std::string Wheel(const std::string& integrator, const std::string& more = "") {
    return "<mujoco><option timestep=\"2e-3\" integrator=\"" + integrator + "\"/>" +
           Instance("directional_friction", Key("joint", "q") + Key("tau_c_plus", "0.06") +
                                                Key("tau_c_minus", "0.03") + more) +
           R"(<worldbody><body><joint name="q" axis="1 0 0"/>
              <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody>
              <actuator><motor joint="q"/></actuator></mujoco>)";
  }
};
INSTANTIATE_TEST_SUITE_P(All, Directional,
                         ::testing::Values("Euler", "RK4", "implicitfast", "implicit"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(Directional, HoldsOnEitherSideBelowItsOwnLevel) {
  const auto m = Model(Wheel(GetParam()));
  for (const double torque : {0.95 * kPlus, 0.5 * kPlus, -0.95 * kMinus}) {
    const auto d = Data(m);
    d->ctrl[0] = torque;
    RunUntil(m, d, 1);
    const double start = d->qpos[0];
    RunUntil(m, d, 31);
    EXPECT_LT(std::abs(d->qpos[0] - start), 1e-6);
    EXPECT_LT(std::abs(start), 1e-4);
  }
}

TEST_P(Directional, BreaksAwayOnEitherSideAtItsOwnLevel) {
  const auto m = Model(Wheel(GetParam()));
  for (const double level : {kPlus, -kMinus}) {
    const auto d = Data(m);
    const double rate = 5e-4;
    while (std::abs(d->qvel[0]) < 1e-3 && d->time < 20) {
      d->ctrl[0] = 0.9 * level + std::copysign(rate * d->time, level);
      mj_step(m.get(), d.get());
    }
    // Past the level sqrt(2 I v/rate) = 0.28 s to 1 mrad/s: 1.4e-4 N m.
    EXPECT_NEAR(d->ctrl[0], level, 0.01 * std::abs(level));
  }
}

TEST_P(Directional, KeepsHoldingWhenTheLoadChangesSides) {
  const auto m = Model(Wheel(GetParam()));
  const auto d = Data(m);
  for (int k = 0; k < 8; ++k) {
    d->ctrl[0] = k % 2 ? -0.9 * kMinus : 0.9 * kPlus;
    RunUntil(m, d, 0.5 * (k + 1));
  }
  EXPECT_LT(std::abs(d->qpos[0]), 1e-4);
  d->ctrl[0] = -0.9 * kPlus;  // beyond the other side's level
  RunUntil(m, d, 5);
  EXPECT_LT(d->qvel[0], -0.5);
}

// From just below one level to just below the other: it is not let go on the way, which would take
// it on by some 1e-4 rad each time. The row's own deflection is 1e-5 rad.
TEST_P(Directional, HoldsThroughSuddenReversals) {
  const auto m = Model(Wheel(GetParam()));
  for (const double part : {0.9, 0.99}) {
    const auto d = Data(m);
    for (int k = 0; k < 10; ++k) {
      d->ctrl[0] = part * (k % 2 ? kPlus : -kMinus);
      RunUntil(m, d, 0.2 * (k + 1));
      EXPECT_LT(std::abs(d->qpos[0]), 1e-4) << part << " " << k;
    }
  }
}

// What slides one way and is pushed back stops and stays, whichever side holds more.
TEST_P(Directional, StopsAndStaysUnderAPushBack) {
  const auto m = Model(Wheel(GetParam()));
  for (const double push : {-0.95 * kMinus, 0.95 * kPlus}) {
    const auto d = Data(m);
    d->qvel[0] = std::copysign(0.3, -push);
    d->ctrl[0] = push;
    RunUntil(m, d, 1);
    const double stop = d->qpos[0];
    EXPECT_LT(std::abs(d->qvel[0]), 1e-9);
    RunUntil(m, d, 11);
    EXPECT_NEAR(d->qpos[0], stop, 1e-9);
    // It stops after v²/2a, to within a step of the travel.
    const double level = push > 0 ? kMinus : kPlus, a = (level + std::abs(push)) / kInertia;
    EXPECT_NEAR(std::abs(stop), 0.3 * 0.3 / (2 * a), 0.3 * m->opt.timestep) << push;
  }
}

// Without rows there is no friction at all.
TEST_F(Directional, VanishesWithTheRows) {
  const auto m = Model(Wheel("implicitfast"));
  m->opt.disableflags |= mjDSBL_FRICTIONLOSS;
  const auto d = Data(m);
  RunUntil(m, d, 1);
  EXPECT_EQ(d->qvel[0], 0);
}

// The load of a gear is what others do to it.
TEST_F(Directional, IsNoLoadToTheGear) {
  std::string xml = Wheel("implicitfast");
  xml.insert(xml.find("<plugin plugin=\"continuum.dir"),
             "<plugin plugin=\"continuum.load_friction\"><instance name=\"l\">" +
                 Key("joint", "q") + Key("mu_l", "0.5") + "</instance></plugin>");
  const auto m = Model(xml);
  const auto d = Data(m);
  d->ctrl[0] = 0.04;
  for (int k = 0; k < 3; ++k) mj_step(m.get(), d.get());
  EXPECT_NEAR(d->efc_frictionloss[0], 0.5 * (kPlus + kMinus) + 0.5 * 0.5 * 0.04, 1e-15);
}

// I dv/dt = T − τ_c − b v from rest: v = v_end (1 − exp(−b t/I)), v_end = (T − τ_c)/b.
TEST_P(Directional, SlidesOnEitherSideAsTheClosedForm) {
  for (const auto& [torque, level, b] :
       {std::tuple{0.1, kPlus, 0.04}, std::tuple{-0.1, -kMinus, 0.02}}) {
    const double end = (torque - level) / b, T = kInertia / b, t = 0.8;
    const double exact = end * (t - T * (1 - std::exp(-t / T)));
    double before = 1;
    for (const double h : {2e-3, 1e-3, 5e-4}) {
      const auto m = Model(Wheel(GetParam(), Key("b_plus", "0.04") + Key("b_minus", "0.02")));
      m->opt.timestep = h;
      const auto d = Data(m);
      d->ctrl[0] = torque;
      RunUntil(m, d, t);
      const double error = std::abs(d->qpos[0] / exact - 1);
      EXPECT_LT(error, 0.65 * before) << h;
      before = error;
    }
    EXPECT_LT(before, 2e-3);
  }
}

TEST_F(Directional, AddsToAnotherFrictionOnTheSameJoint) {
  std::string xml = Wheel("implicitfast");
  xml.insert(xml.find("<plugin plugin=\"continuum.dir"),
             "<plugin plugin=\"continuum.coulomb\"><instance name=\"c\">" + Key("joint", "q") +
                 Key("tau_c", "0.02") + "</instance></plugin>");
  const auto m = Model(xml);
  const auto d = Data(m);
  for (const double torque : {0.95 * (kPlus + 0.02), -0.95 * (kMinus + 0.02)}) {
    mj_resetData(m.get(), d.get());
    d->ctrl[0] = torque;
    RunUntil(m, d, 10);
    EXPECT_LT(std::abs(d->qpos[0]), 1e-4);
    d->ctrl[0] = torque * 1.05 / 0.95;
    RunUntil(m, d, 15);
    EXPECT_GT(std::abs(d->qpos[0]), 0.1);
  }
}

}  // namespace
}  // namespace continuum
