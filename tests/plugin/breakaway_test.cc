#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kTauC = 0.1, kS = 0.7, kLevel = kTauC * (1 + kS);

class Breakaway : public testing::Engine {
 protected:
  static testing::Owned<mjModel> Body(const std::string& type, double inertia, double h,
                                      const std::string& v_d = "0.3") {
    const std::string i = std::to_string(inertia);
    auto m = Model("<mujoco><option integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
                   Instance("stribeck", Key("joint", "q") + Key("tau_c", "0.1") + Key("S", "0.7") +
                                            Key("v_d", v_d)) +
                   "<worldbody><body><joint name=\"q\" type=\"" + type +
                   "\"/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"" + i + " " + i + " " + i +
                   "\"/></body></worldbody></mujoco>");
    m->opt.timestep = h;
    return m;
  }
  // Whether the joint still turns when a torque has acted for a while.
  static bool Lets(const testing::Owned<mjModel>& m, const std::vector<double>& torque) {
    const auto d = Data(m);
    std::copy(torque.begin(), torque.end(), d->qfrc_applied);
    RunUntil(m, d, 0.4);
    return mju_norm(d->qvel, static_cast<int>(m->nv)) > 1e-3;
  }
};

// The elastic deflection of a held row is fast where the inertia is small; it is no sliding.
TEST_F(Breakaway, ASuddenLoadBreaksAwayAtTheStaticLevelWhateverTheInertia) {
  for (const double inertia : {0.02, 0.002, 2.3e-4, 1e-5}) {
    for (const double h : {2e-3, 5e-4}) {
      const auto m = Body("hinge", inertia, h);
      for (const double sign : {1.0, -1.0}) {
        EXPECT_FALSE(Lets(m, {sign * 0.98 * kLevel})) << inertia << " " << h;
        EXPECT_TRUE(Lets(m, {sign * 1.02 * kLevel})) << inertia << " " << h;
      }
    }
  }
}

// Within the first step the stages of RK4 see the row deflect, however low the Stribeck speed.
TEST_F(Breakaway, ASuddenLoadAtTheBeginningBreaksAwayAtTheStaticLevelWhateverTheStribeckSpeed) {
  for (const std::string type : {"hinge", "slide", "ball"}) {
    const auto m = Body(type, 0.02, 2e-3, "1e-9");
    for (const int integrator : {mjINT_EULER, mjINT_RK4, mjINT_IMPLICIT, mjINT_IMPLICITFAST}) {
      m->opt.integrator = integrator;
      EXPECT_FALSE(Lets(m, {0.98 * kLevel})) << type << integrator;
      EXPECT_TRUE(Lets(m, {1.02 * kLevel})) << type << integrator;
    }
  }
}

// What moves when it begins slides from the first stage on.
TEST_F(Breakaway, WhatBeginsInMotionSlides) {
  const auto m = Body("hinge", 0.02, 2e-3, "1e-9");
  for (const int integrator : {mjINT_RK4, mjINT_IMPLICITFAST}) {
    m->opt.integrator = integrator;
    const auto d = Data(m);
    d->qvel[0] = 2;
    RunUntil(m, d, 0.2);
    EXPECT_NEAR(d->qvel[0], 2 - kTauC / 0.02 * 0.2, 1e-9);
  }
}

TEST_F(Breakaway, ABallJointSlidesAgainstItsOwnAngularVelocity) {
  const auto m = Body("ball", 0.02, 2e-3);
  for (const std::vector<double>& w :
       {std::vector{5., 0., 0.}, {5., 0.5, 0.}, {5., -5., 5.}, {0.2, 0.02, 0.1}}) {
    const auto d = Data(m);
    std::copy(w.begin(), w.end(), d->qvel);
    mj_forward(m.get(), d.get());
    const double speed = mju_norm3(w.data()),
                 level = kTauC * (1 + kS * std::exp(-speed * speed / 0.09));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(d->qfrc_constraint[k], -level * w[k] / speed, 1e-6) << w[0] << " " << k;
    }
  }
}

// I dω/dt = −τ_c ω/|ω|: a free body keeps its axis and stops after I |ω|/τ_c = 0.6 s.
TEST_F(Breakaway, ABallJointKeepsItsAxisUntilItStops) {
  const auto m =
      Model("<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
            Instance("coulomb", Key("joint", "q") + Key("tau_c", "0.1")) +
            R"(<worldbody><body><joint name="q" type="ball"/>
         <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody></mujoco>)");
  const auto d = Data(m);
  const double w[3] = {2, -1, 2};
  std::copy_n(w, 3, d->qvel);
  RunUntil(m, d, 0.5);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(d->qvel[k], w[k] * (1 - 0.5 / 0.6), 1e-3);
  RunUntil(m, d, 1);
  double turn[3];
  mju_quat2Vel(turn, d->qpos, 1);
  // The last step stops within its own length: |ω| h/2 of the path.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(turn[k], w[k] * 0.3, 3e-3);
  EXPECT_LT(mju_norm3(d->qvel), 1e-6);
}

}  // namespace
}  // namespace continuum
