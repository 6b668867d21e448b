// Friction of a loaded gear in MuJoCo: it holds without creep, breaks away at its level,
// dissipates.
#include <cmath>
#include <string>

#include "effects/gear_friction.h"
#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kMass = 0.5, kArm = 0.1, kGravity = 9.81;
constexpr Vec<double, 11> kLaw{0.01, 0.1, 0.25, 0.02, 0.05, 0.1, 0.3, 0.2, 0.2, 1.35, 0};

class GearedPendulum : public testing::Engine, public ::testing::WithParamInterface<const char*> {
 protected:
  static std::string Pendulum(const std::string& integrator, const std::string& law = Law()) {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"" + integrator + "\"/>" +
           Instance("gear_friction", Key("joint", "q") + law) +
           R"(<worldbody><body><joint name="q" axis="0 1 0"/>
              <inertial pos="0 0 -.1" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/></body></worldbody>
              <actuator><motor joint="q"/></actuator></mujoco>)";
  }
  static std::string Law() {
    std::string keys;
    for (std::size_t i = 0; i < kLaw.size(); ++i)
      keys += Key(std::string(GearFriction::kParams[i].name), std::to_string(kLaw[i]));
    return keys;
  }
  // What holds at rest at an angle under a torque of the motor.
  static double Level(double motor, double q) {
    return GearFriction::Level<double>({q, 0, 0, motor, Weight(q)}, kLaw);
  }
  static double Weight(double q) { return -kMass * kGravity * kArm * std::sin(q); }
};
INSTANTIATE_TEST_SUITE_P(All, GearedPendulum,
                         ::testing::Values("Euler", "RK4", "implicitfast", "implicit"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(GearedPendulum, LoadsTheRowWithMotorAndWeight) {
  const auto m = Model(Pendulum(GetParam()));
  for (const auto& [q, torque] : {std::pair{0.5, 0.3}, {0.5, 0.1}, {-0.9, 0.2}}) {
    const auto d = Data(m);
    d->qpos[0] = q, d->ctrl[0] = torque;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->efc_frictionloss[0], Level(torque, q), 1e-12);
  }
}

// The motor holds the weight to within 95 % of what friction takes, from either side.
TEST_P(GearedPendulum, HoldsBelowItsLevelWithoutCreep) {
  const auto m = Model(Pendulum(GetParam()));
  const double q = 0.6;
  for (const double excess : {0.02, 0.0, -0.02}) {
    const double motor = -Weight(q) + excess;
    ASSERT_LT(std::abs(excess), 0.95 * Level(motor, q));
    const auto d = Data(m);
    d->qpos[0] = q, d->ctrl[0] = motor;
    RunUntil(m, d, 1);
    const double start = d->qpos[0];
    RunUntil(m, d, 31);
    EXPECT_LT(std::abs(d->qpos[0] - start), 1e-6);
    EXPECT_LT(std::abs(start - q), 1e-4);
  }
}

// Lifting and letting down begin where motor and weight differ by the level that they themselves
// make: the gear holds more when it is driven back.
TEST_P(GearedPendulum, BreaksAwayAtTheLevelOfItsLoad) {
  const auto m = Model(Pendulum(GetParam()));
  const double q = 0.6, rate = 2e-3;
  for (const double side : {1.0, -1.0}) {
    double expected = -Weight(q);
    while (std::abs(expected + Weight(q)) < Level(expected, q)) expected += side * 1e-6;
    const auto d = Data(m);
    d->qpos[0] = q;
    const double from = -Weight(q) + 0.9 * (expected + Weight(q));
    while (std::abs(d->qvel[0]) < 1e-3 && d->time < 30) {
      d->ctrl[0] = from + side * rate * d->time;
      mj_step(m.get(), d.get());
    }
    // Past the level the speed needs sqrt(2 I v/rate) < 0.1 s to 1 mrad/s: 2e-4 N m.
    EXPECT_NEAR(d->ctrl[0], expected, 0.01 * std::abs(expected + Weight(q)) + 2e-4) << side;
  }
}

// What swings without a motor only loses energy.
TEST_P(GearedPendulum, NeverCreatesEnergy) {
  const auto m = Model(Pendulum(GetParam()));
  m->opt.enableflags |= mjENBL_ENERGY;
  const auto d = Data(m);
  d->qpos[0] = 2.5;
  mj_forward(m.get(), d.get());
  const double h = m->opt.timestep;
  double least = d->energy[0] + d->energy[1];
  while (d->time < 5) {
    mj_step(m.get(), d.get());
    mj_forward(m.get(), d.get());
    const double energy = d->energy[0] + d->energy[1];
    // Euler's steps of a pendulum err by up to h ω E; what friction takes is much more.
    EXPECT_LE(energy, least + h * 10 * kMass * kGravity * kArm);
    least = std::min(least, energy);
  }
  EXPECT_LT(std::abs(d->qvel[0]), 1e-9);
}

// With give the joint yields like a spring, comes back, and slides where it would have slid. Loads
// change slowly: a sudden one would throw its inertia over the level.
TEST_P(GearedPendulum, YieldsBeforeItSlides) {
  constexpr double kGive = 0.01, kLevel = 0.06;
  const auto m = Model(Pendulum(GetParam(), Key("tau_c", "0.06") + Key("give", "0.01")));
  m->opt.disableflags |= mjDSBL_GRAVITY;
  m->dof_damping[0] = 0.2;
  const auto d = Data(m);
  const auto load = [&](double share) {
    const double from = d->ctrl[0], start = d->time;
    while (d->time < start + 3) {
      d->ctrl[0] = from + (share * kLevel - from) * std::min(1.0, 0.5 * (d->time - start));
      mj_step(m.get(), d.get());
    }
  };
  for (const double share : {0.5, -0.8, 0.0, 0.9}) {
    load(share);
    EXPECT_NEAR(d->qpos[0], share * kGive, 0.01 * kGive) << share;
  }
  const double held = d->qpos[0];
  RunUntil(m, d, d->time + 20);
  EXPECT_NEAR(d->qpos[0], held, 1e-6);
  load(1.2);
  const double end = d->qpos[0];
  EXPECT_GT(end, 3 * kGive);
  load(0);  // it swings back by what it was wound up
  EXPECT_LT(std::abs(d->qvel[0]), 1e-6);
  EXPECT_GT(d->qpos[0], end - kGive);
}

TEST_F(GearedPendulum, GivesOnlyWhereItIsAlone) {
  const std::string xml = Pendulum("implicitfast", Key("tau_c", "0.06") + Key("give", "0.01"));
  std::string loss = xml;
  loss.replace(loss.find("axis=\"0 1 0\""), 12, "axis=\"0 1 0\" frictionloss=\"0.1\"");
  EXPECT_THAT(Compile(loss).error, ::testing::HasSubstr("no other dry friction"));
}

}  // namespace
}  // namespace continuum
