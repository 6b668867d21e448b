#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kMu = 0.3, kLoad = 10, kBand = kMu * M_PI;  // two bends of 90 degrees
constexpr double kGive = 1e-3;                               // [m]

// A load on a rail hangs on a cable over two fixed corners. Both contacts slide by what it moves.
class CableGive : public testing::Engine, public ::testing::WithParamInterface<double> {
 protected:
  static testing::Owned<mjModel> Rail(const std::string& joint = "damping=\"20\"",
                                      const std::string& mass = "0.1") {
    auto m = Model("<mujoco><option integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
                   Instance("capstan", Key("tendon", "cable") + Key("mu", std::to_string(kMu)) +
                                           Key("give", std::to_string(kGive))) +
                   R"(<worldbody><site name="s0" pos="0 0 0"/><site name="s1" pos="0 0 9"/>
           <site name="s2" pos="1 0 9"/>
           <body pos="1 0 0"><joint type="slide" axis="0 0 1" )" +
                   joint + "/><geom size=\".05\" mass=\"" + mass +
                   R"("/><site name="s3"/></body></worldbody>
           <tendon><spatial name="cable"><site site="s0"/><site site="s1"/><site site="s2"/>
             <site site="s3"/></spatial></tendon>
           <actuator><motor tendon="cable" gear="-1"/></actuator></mujoco>)");
    m->opt.timestep = GetParam();
    return m;
  }

  // Changes the tension slowly, so that inertia and damping are nothing.
  static void Pull(const mjModel* m, mjData* d, double tension) {
    const double from = d->ctrl[0], start = d->time, time = 4;
    while (d->time < start + 1.25 * time) {
      d->ctrl[0] = from + (tension - from) * std::min(1.0, (d->time - start) / time);
      mj_step(m, d);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Step, CableGive, ::testing::Values(5e-4, 1e-3, 2e-3));

// T e^(−band x/give) = W, up to x = give.
TEST_P(CableGive, YieldsInProportionToTheFrictionAndComesBack) {
  const auto m = Rail();
  const auto d = Data(m);
  d->qfrc_applied[0] = -kLoad;
  d->ctrl[0] = kLoad;
  for (const double share : {0.4, 0.8, 0.1, -0.6, 0.0}) {
    Pull(m.get(), d.get(), kLoad * std::exp(share * kBand));
    EXPECT_NEAR(d->qpos[0], share * kGive, 0.01 * kGive) << share;
  }
}

TEST_P(CableGive, HoldsWithoutDriftAndBreaksAwayWhereTheLawSays) {
  const auto m = Rail();
  for (const double way : {1.0, -1.0}) {
    const auto d = Data(m);
    d->qfrc_applied[0] = -kLoad;
    d->ctrl[0] = kLoad;
    Pull(m.get(), d.get(), kLoad * std::exp(way * 0.95 * kBand));
    const double held = d->qpos[0];
    EXPECT_NEAR(held, way * 0.95 * kGive, 0.01 * kGive);
    RunUntil(m, d, d->time + 60);
    EXPECT_NEAR(d->qpos[0], held, 1e-8);
    Pull(m.get(), d.get(), kLoad * std::exp(way * 0.99 * kBand));
    EXPECT_LT(std::abs(d->qpos[0]), kGive);
    Pull(m.get(), d.get(), kLoad * std::exp(way * 1.02 * kBand));
    EXPECT_GT(std::abs(d->qpos[0]), 5 * kGive);
  }
}

// A sprung mass of 1 kg at constant tension swings over many times the give, then within it.
TEST_P(CableGive, TakesEnergyOnlyAtConstantTension) {
  const auto m = Rail("stiffness=\"400\"", "1");
  const auto d = Data(m);
  d->ctrl[0] = kLoad;
  d->qpos[0] = 0.08;
  // Of mass, spring, and the tension that would be there without friction.
  const auto energy = [&] {
    return 0.5 * d->qvel[0] * d->qvel[0] + 200 * d->qpos[0] * d->qpos[0] - kLoad * d->qpos[0];
  };
  mj_step(m.get(), d.get());
  const double swing = energy();
  double least = swing;
  // The give stores at most the largest force of friction over its length. Euler's steps of a
  // spring err by up to h ω of the energy.
  const double stored = kLoad * std::expm1(kBand) * kGive, rounding = 20 * GetParam() * swing;
  while (d->time < 5) {
    mj_step(m.get(), d.get());
    EXPECT_LT(energy(), least + stored + rounding);
    least = std::min(least, energy());
  }
  EXPECT_LT(std::abs(d->qvel[0]), 1e-3);
}

}  // namespace
}  // namespace continuum
