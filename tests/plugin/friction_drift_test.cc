// Friction that changes with the work that it has dissipated, in MuJoCo.
#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kEnd = 0.05, kMore = 0.04, kRate = 3;

class DriftingWheel : public testing::Engine {
 protected:
  static std::string Wheel(const std::string& rates) {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\"/>" +
           Instance("friction_drift",
                    Key("joint", "q") + Key("tau_c", "0.05") + Key("delta", "0.04") + rates) +
           R"(<worldbody><body><joint name="q" axis="1 0 0"/>
              <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody>
              <actuator><motor joint="q"/></actuator></mujoco>)";
  }
};

// Of dW = (τ_c + Δ exp(−r W)) dx: τ_c exp(r W) + Δ grows as exp(r τ_c x).
double WorkOf(double path) {
  const double u = (kEnd + kMore) * std::exp(kRate * kEnd * path);
  return std::log((u - kMore) / kEnd) / kRate;
}

TEST_F(DriftingWheel, RunsInAlongItsPath) {
  const auto m = Model(Wheel(Key("r_W", "3")));
  const auto d = Data(m);
  d->ctrl[0] = 0.2;
  RunUntil(m, d, 2);
  const double expected = kEnd + kMore * std::exp(-kRate * WorkOf(d->qpos[0]));
  EXPECT_LT(expected, 0.9 * (kEnd + kMore));
  // The work of a step is that of its end: an error of the order of a step's share of the path.
  EXPECT_NEAR(d->efc_frictionloss[0], expected, 1e-3 * kMore);
}

// What the motor has given is in the wheel or has gone into the friction, whose work is WorkOf.
TEST_F(DriftingWheel, TakesWhatTheMotorGivesAndTheWheelHasNot) {
  const auto m = Model(Wheel(Key("r_W", "3")));
  const auto d = Data(m);
  d->ctrl[0] = 0.2;
  for (const double time : {0.2, 0.5, 2.0}) {
    RunUntil(m, d, time);
    const double given = d->ctrl[0] * d->qpos[0], kept = 0.5 * 0.02 * d->qvel[0] * d->qvel[0];
    // An Euler step works over its end's speed: a share h/t of the energy.
    EXPECT_NEAR(given - kept, WorkOf(d->qpos[0]), 1e-3 / time * given) << time;
  }
}

TEST_F(DriftingWheel, DoesNotRunInAtRest) {
  const auto m = Model(Wheel(Key("r_W", "3")));
  const auto d = Data(m);
  d->ctrl[0] = 0.9 * (kEnd + kMore);
  RunUntil(m, d, 20);
  EXPECT_DOUBLE_EQ(d->efc_frictionloss[0], kEnd + kMore);
  EXPECT_LT(std::abs(d->qpos[0]), 1e-4);
}

TEST_F(DriftingWheel, BreaksAwayWhenItHasFadedBelowTheLoad) {
  const auto m = Model(Wheel(Key("r_t", "0.2")));
  const auto d = Data(m);
  d->ctrl[0] = kEnd + 0.5 * kMore;
  while (std::abs(d->qvel[0]) < 1e-3 && d->time < 20) mj_step(m.get(), d.get());
  // ln 2/0.2 = 3.47 s; then sqrt(2 I v/rate) = 0.1 s to 1 mrad/s at 4e-3 N m/s.
  EXPECT_NEAR(d->time, std::log(2) / 0.2, 0.15);
}

// It begins without friction of its own, on a joint that has MuJoCo's.
TEST_F(DriftingWheel, GrowsFromNothingBesideNativeFriction) {
  const auto m = Model("<mujoco>" +
                       Instance("friction_drift", Key("joint", "q") + Key("tau_c", "0.05") +
                                                      Key("delta", "-0.05") + Key("r_t", "3")) +
                       R"(<worldbody><body><joint name="q" axis="1 0 0" frictionloss="0.03"/>
         <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody></mujoco>)");
  const auto d = Data(m);
  RunUntil(m, d, 0.4);
  mj_forward(m.get(), d.get());
  EXPECT_NEAR(d->efc_frictionloss[0], 0.03 + 0.05 * (1 - std::exp(-3 * d->time)), 1e-12);
}

}  // namespace
}  // namespace continuum
