// Cable friction where the links weigh grams: what friction can stop within a step it stops, at any
// inertia and usual step.
#include <cmath>
#include <string>

#include "support/cable_arm.h"
#include "support/engine.h"
#include "support/long_test.h"

namespace continuum {
namespace {

constexpr double kMu = 0.3, kLoad = 10, kBand = kMu * M_PI;    // two bends of 90 degrees
constexpr double kGiveWay = 1e-3, kBristle = 2e-3 * kGiveWay;  // [m/s], [m] at a step of 2 ms

class Slider : public testing::Engine, public ::testing::WithParamInterface<double> {
 protected:
  // A mass on a vertical rail without gravity hangs on a cable over two bends of 90 degrees.
  static testing::Owned<mjModel> Rail(double mass, double damping, double mu = kMu,
                                      const std::string& joint = "") {
    return Model(
        "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
        Instance("capstan", Key("tendon", "cable") + Key("mu", std::to_string(mu))) +
        R"(<worldbody><site name="s0" pos="0 0 0"/><site name="s1" pos="0 0 9"/>
           <site name="s2" pos="1 0 9"/>
           <body pos="1 0 0"><joint type="slide" axis="0 0 1" damping=")" +
        std::to_string(damping) + "\" " + joint + R"(/><geom size=".05" mass=")" +
        std::to_string(mass) +
        R"("/><site name="s3"/></body></worldbody>
           <tendon><spatial name="cable"><site site="s0"/><site site="s1"/><site site="s2"/>
             <site site="s3"/></spatial></tendon>
           <actuator><motor tendon="cable" gear="-1"/></actuator>
           <sensor><plugin plugin="continuum.capstan" instance="i" objtype="site" objname="s1"/>
             <plugin plugin="continuum.capstan" instance="i" objtype="site" objname="s2"/></sensor>
           </mujoco>)");
  }
};
INSTANTIATE_TEST_SUITE_P(Mass, Slider, ::testing::Values(1e-3, 1e-2, 0.1, 1.0));

TEST_P(Slider, BreaksAwayWhereTheLawSays) {
  const auto m = Rail(GetParam(), 0);
  for (const int direction : {1, -1}) {
    const auto d = Data(m);
    d->qfrc_applied[0] = -kLoad;
    // 1 kg reaches 2 mm/s when the tension is sqrt(2 rate M v) = 0.05 N too high, 0.5 % of the
    // least.
    double& tension = d->ctrl[0] = kLoad;
    while (std::abs(d->qvel[0]) < 2e-3 && d->time < 100) {
      tension += direction * 0.5 * m->opt.timestep;
      mj_step(m.get(), d.get());
    }
    EXPECT_NEAR(std::log(tension / kLoad) / (direction * kBand), 1, 0.01) << direction;
  }
}

// A bristle of 1 mm/s · h gives way within a few steps; then nothing moves.
TEST_P(Slider, HoldsWithoutDriftBelowIt) {
  const auto m = Rail(GetParam(), 0);
  for (const double part : {-0.99, -0.5, 0.5, 0.99}) {
    const auto d = Data(m);
    d->qfrc_applied[0] = -kLoad;
    d->ctrl[0] = kLoad * std::exp(part * kBand);
    RunUntil(m, d, 1);
    const double settled = d->qpos[0];
    EXPECT_LT(std::abs(settled), 10 * kBristle) << part;
    RunUntil(m, d, 20);
    EXPECT_NEAR(d->qpos[0], settled, 1e-9) << part;
  }
}

TEST_P(Slider, SlidesAtTheLawsRatioWithoutChatter) {
  const double damping = std::max(0.2, 5 * GetParam());
  const auto m = Rail(GetParam(), damping);
  for (const double speed : {-1.0, -0.1, -0.01, 0.01, 0.1, 1.0}) {
    const double sign = speed > 0 ? 1 : -1;
    const auto d = Data(m);
    d->qfrc_applied[0] = -kLoad;
    d->ctrl[0] = (kLoad + damping * speed) * std::exp(sign * kBand);
    d->qvel[0] = 0.8 * speed;
    int turns = 0;
    double last = 0;
    while (d->time < 3) {
      mj_step(m.get(), d.get());
      const double now = std::abs(d->qacc[0]) > 1e-9 ? d->qacc[0] : 0;
      turns += now * last < 0;
      if (now != 0) last = now;
    }
    EXPECT_EQ(turns, 0) << speed;
    EXPECT_NEAR(d->qvel[0], speed, 1e-6) << speed;
    EXPECT_NEAR(std::log(d->sensordata[1] / d->ctrl[0]), -sign * kBand, 1e-9) << speed;
  }
}

// It stops in one step or in many and comes back no faster than its bristle.
TEST_P(Slider, StopsWhenNothingPullsItAndStays) {
  const auto m = Rail(GetParam(), 0);
  const auto d = Data(m);
  d->ctrl[0] = kLoad;
  d->qfrc_applied[0] = -kLoad;
  d->qvel[0] = 0.5;
  while (d->time < 1) {
    const double before = d->qvel[0];
    mj_step(m.get(), d.get());
    EXPECT_LE(d->qvel[0], std::max(before, 2 * kGiveWay));
    EXPECT_GE(d->qvel[0], -2 * kGiveWay);
  }
  EXPECT_LT(std::abs(d->qvel[0]), 1e-9);
}

TEST_P(Slider, MuchFrictionLocks) {
  const auto m = Rail(GetParam(), 0, 50);
  const auto d = Data(m);
  d->qfrc_applied[0] = -kLoad;
  for (const double tension : {1.0, 1e3, 1e-3, kLoad}) {
    d->ctrl[0] = tension;
    for (int k = 0; k < 200; ++k) {
      mj_step(m.get(), d.get());
      ASSERT_LT(std::abs(d->qpos[0]), 20 * kBristle) << tension;
    }
    EXPECT_NEAR(d->sensordata[1], kLoad, 1e-6) << tension;
  }
}

// Pressed against a stop, cable and stop share what the load takes or leaves. The stop's force
// comes into the cable's balance a step late: for that step alone the contacts give way, by less
// than a bristle.
TEST_P(Slider, HoldsAtAStopWhereItsLoadChanges) {
  const auto m =
      Rail(GetParam(), 0, kMu, "limited=\"true\" range=\"-1 .001\" solreflimit=\".01 1\"");
  const auto d = Data(m);
  d->ctrl[0] = 4 * kLoad;
  for (const double load : {0.5, 1.2, 0.2, 0.5}) {
    const double held = d->qpos[0];
    for (int k = 0; k < 250; ++k) {
      d->qfrc_applied[0] = -load * kLoad;
      mj_step(m.get(), d.get());
      if (d->time < 0.6) continue;  // on the way there
      EXPECT_NEAR(d->qpos[0], held, kBristle) << load;
    }
    EXPECT_LT(d->qfrc_constraint[0], -1);
  }
}

class LightArm : public testing::Engine {
 protected:
  using Arm = testing::CableArm;

  struct Pull {
    double angle;     ///< sum of the joints after the pull was halved [rad]
    double given;     ///< largest power that friction ever gave [W]
    double taken;     ///< energy that friction took [J]
    double returned;  ///< energy that it gave back [J]
    double speed;     ///< at the end [rad/s]
  };
  // Pulled at one side to 6 N, let go to half of it, against 2 N at the other.
  static Pull PullAndLetGo(const Arm& arm, double h, const std::string& integrator) {
    const auto m = Model(arm.Mjcf(integrator));
    m->opt.timestep = h;
    const auto d = Data(m);
    Pull pull{};
    while (d->time < 1.5) {
      d->ctrl[0] = 2 + 4 * (d->time < 0.5 ? 2 * d->time : std::max(0.5, 1.5 - d->time));
      d->ctrl[1] = 2;
      mj_step(m.get(), d.get());
      double power = 0;
      for (int i = 0; i < m->nv; ++i) {
        power += (d->qfrc_passive[i] - d->qfrc_spring[i] - d->qfrc_damper[i]) * d->qvel[i];
      }
      pull.given = std::max(pull.given, power);
      pull.taken -= h * power;
      pull.returned += h * std::max(0.0, power);
    }
    for (int i = 0; i < m->nv; ++i) pull.angle += d->qpos[i], pull.speed += std::abs(d->qvel[i]);
    return pull;
  }
};

TEST_F(LightArm, HoldsTheSameOffsetAt2MillisecondsAsAt100Microseconds) {
  CONTINUUM_LONG_IF_SANITIZED("small steps");
  for (const auto& [links, mass] : {std::pair{5, 1e-3}, {5, 5e-3}, {10, 1e-3}, {20, 5e-3}}) {
    Arm arm{.links = links, .mass = mass, .mu = 0.3, .stiffness = 0.02 * links};
    Arm free = arm;
    free.mu = 0;
    for (const char* integrator : {"implicitfast", "Euler"}) {
      const double native = PullAndLetGo(free, 2e-3, integrator).angle;
      const double fine = PullAndLetGo(arm, 1e-4, integrator).angle - native;
      const Pull coarse = PullAndLetGo(arm, 2e-3, integrator);
      EXPECT_GT(fine, 0.05) << links;
      EXPECT_NEAR(coarse.angle - native, fine, 0.02 * fine) << links << " " << mass;
    }
  }
}

// What a bristle gives back is what it took before: 1 mm/s · h long, at no more than the tension's
// change over all bends, mu · 1.5 rad, in each cable.
TEST_F(LightArm, FrictionTakesEnergyOnly) {
  for (const double h : {2e-3, 2e-4}) {
    const Arm arm{.links = 10, .mass = 1e-3, .mu = 0.3, .stiffness = 0.2};
    const Pull pull = PullAndLetGo(arm, h, "implicitfast");
    EXPECT_GT(pull.taken, 1e-3);
    EXPECT_LT(pull.given, kGiveWay * 2 * 6 * std::exp(0.3 * 1.5));
    EXPECT_LT(pull.returned, 1e-3 * pull.taken);
  }
}

}  // namespace
}  // namespace continuum
