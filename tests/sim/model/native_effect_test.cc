#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/model/model_spec.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class NativeEffect : public ::testing::Test {
 protected:
  static constexpr const char* kModel = R"(<mujoco>
    <worldbody>
      <body name="link" pos="0 0 1" euler="0 90 0"><freejoint/>
        <geom size=".05 .02 .1" type="box" mass=".4" pos="0 0 .1"/><site name="tip" pos="0 0 .2"/>
      </body>
    </worldbody>
    <sensor><framepos name="p" objtype="body" objname="link"/></sensor></mujoco>)";

  ModelSpec Load() const { return ModelSpec::Load(scratch_.Write("m.xml", kModel)); }
  static ModelAndData Forward(const ModelSpec& system, const std::vector<Change>& changes) {
    ModelAndData machine = system.Build(changes);
    mj_forward(machine.model.get(), machine.data.get());
    return machine;
  }
  static std::string Message(const ModelSpec& system, const Change& change) {
    try {
      system.Build({{change}});
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }
  static std::vector<double> Run(const ModelAndData& machine) {
    mjData& d = *machine.data;
    for (int k = 0; k < 200; ++k) mj_step(machine.model.get(), &d);
    return {d.qpos, d.qpos + machine.model->nq};
  }

  testing::Scratch scratch_;
};

TEST_F(NativeEffect, GravityTiltTurnsGravityWhateverTheOrderOfItsParameters) {
  const ModelSpec system = Load();
  const Change roll{"world", "effect:gravity_tilt.roll", 0.3},
      pitch{"world", "effect:gravity_tilt.pitch", -0.2};
  for (const auto& changes : {std::vector{roll, pitch}, std::vector{pitch, roll}}) {
    const ModelAndData machine = system.Build(changes);
    const double* const g = machine.model->opt.gravity;
    EXPECT_NEAR(g[0], -9.81 * std::cos(0.3) * std::sin(-0.2), 1e-14);
    EXPECT_NEAR(g[1], 9.81 * std::sin(0.3), 1e-14);
    EXPECT_NEAR(g[2], -9.81 * std::cos(0.3) * std::cos(-0.2), 1e-14);
  }
  EXPECT_EQ(system.Build().model->opt.gravity[2], -9.81);
  EXPECT_EQ(system.ValueAfter({{roll}}, "world", "effect:gravity_tilt.roll"), 0.3);
  EXPECT_EQ(system.Value("world", "effect:gravity_tilt"), 0);
}

TEST_F(NativeEffect, TorqueLimitNarrowsTheRangeOfTheForce) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("limit.xml", R"(<mujoco><worldbody><body>
      <joint name="j"/><geom size=".1"/></body></worldbody>
      <actuator><motor name="free" joint="j"/><motor name="held" joint="j" forcerange="-1 2"/>
      </actuator></mujoco>)"));
  const ModelAndData machine = system.Build({{{"actuator:*", "effect:torque_limit.limit", 1.5}}});
  const double* const range = machine.model->actuator_forcerange;
  EXPECT_THAT(std::vector<double>(range, range + 4), ::testing::ElementsAre(-1.5, 1.5, -1, 1.5));
  EXPECT_TRUE(machine.model->actuator_forcelimited[0]);
  machine.data->ctrl[0] = 4;
  mj_forward(machine.model.get(), machine.data.get());
  EXPECT_EQ(machine.data->actuator_force[0], 1.5);
  EXPECT_FALSE(system.Build().model->actuator_forcelimited[0]);
}

// I q'' = L − τ_c: a servo far from its goal pushes by its limit, against dry friction.
TEST_F(NativeEffect, ATorqueLimitMovesOnlyWhatItExceeds) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("rub.xml", R"(<mujoco>
      <option gravity="0 0 0" timestep="1e-3" integrator="implicitfast"/><extension>
      <plugin plugin="continuum.coulomb"><instance name="f"><config key="joint" value="j"/>
      <config key="tau_c" value="0.5"/></instance></plugin></extension><worldbody><body>
      <joint name="j"/><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body></worldbody>
      <actuator><position name="u" joint="j" kp="900"/></actuator></mujoco>)"));
  for (const double limit : {0.49, 0.51, 1.5}) {
    const ModelAndData machine = system.Build({{{"actuator:u", "effect:torque_limit", limit}}});
    mjData& d = *machine.data;
    d.ctrl[0] = 100;
    while (d.time < 1 - 1e-9) mj_step(machine.model.get(), &d);
    const double acceleration = std::max(0.0, limit - 0.5) / 0.1;
    EXPECT_NEAR(d.qvel[0], acceleration, 1e-3) << limit;
    EXPECT_NEAR(d.qpos[0], acceleration / 2, 1e-3 * (1 + acceleration)) << limit;
    EXPECT_LE(0.5 * 0.1 * d.qvel[0] * d.qvel[0], (limit - 0.5) * d.qpos[0] + 1e-4) << limit;
  }
}

// m g l sin q = L: an arm whose servo is too weak for its goal rests where its weight is the limit.
TEST_F(NativeEffect, AServoAtItsTorqueLimitHoldsItsWeightWithoutDrift) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("arm.xml", R"(<mujoco>
      <option timestep="1e-3" integrator="implicitfast"/><worldbody><body>
      <joint name="j" axis="0 1 0" damping="0.5"/><inertial pos="0 0 -0.3" mass="1"
      diaginertia="0.01 0.01 0.01"/></body></worldbody>
      <actuator><position name="u" joint="j" kp="50"/></actuator></mujoco>)"));
  const ModelAndData machine = system.Build({{{"actuator:u", "effect:torque_limit", 1.2}}});
  mjData& d = *machine.data;
  d.ctrl[0] = 1.5;
  while (d.time < 10 - 1e-9) mj_step(machine.model.get(), &d);
  EXPECT_NEAR(d.qpos[0], std::asin(1.2 / (9.81 * 0.3)), 1e-6);
  const double held = d.qpos[0];
  while (d.time < 20 - 1e-9) mj_step(machine.model.get(), &d);
  EXPECT_NEAR(d.qpos[0], held, 1e-9);
}

TEST_F(NativeEffect, AForceLimitThatLeavesNoRangeIsRefused) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("limit.xml", R"(<mujoco><worldbody><body>
      <joint name="j"/><geom size=".1"/></body></worldbody>
      <actuator><motor name="pull" joint="j" forcerange="1 2"/></actuator></mujoco>)"));
  const auto message = [&](double limit) {
    try {
      system.Build({{{"actuator:pull", "force_limit", limit}}});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message(0), ::testing::HasSubstr("force_limit: expected a positive number, found 0"));
  EXPECT_THAT(message(0.5), ::testing::HasSubstr("within its forcerange, 1 to 2, found 0.5"));
}

TEST_F(NativeEffect, SitePlaceMovesASiteInTheAxesOfItsBody) {
  const ModelSpec system = Load();
  const ModelAndData machine = Forward(system, {{"site:tip", "effect:site_place.dx", 0.03},
                                                {"site:tip", "effect:site_place.dz", -0.05}});
  const double* const tip = machine.data->site_xpos;  // the body is turned: x down, z along x
  EXPECT_NEAR(tip[0], 0.15, 1e-15);
  EXPECT_NEAR(tip[1], 0, 1e-15);
  EXPECT_NEAR(tip[2], 1 - 0.03, 1e-15);
}

// A hole of a cable on a lever: its length, and its arm, from the triangle of axis and both holes.
TEST_F(NativeEffect, SitePlaceMovesTheCableThroughIt) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("cable.xml", R"(<mujoco><worldbody>
      <site name="guide" pos="0.4 0 0"/><body><joint name="j" axis="0 0 1"/><geom size=".1"/>
      <site name="hole" pos="0.2 0 0"/></body></worldbody><tendon><spatial name="cable">
      <site site="guide"/><site site="hole"/></spatial></tendon>
      <actuator><motor name="u" tendon="cable" gear="-1"/></actuator></mujoco>)"));
  const ModelAndData machine = system.Build(
      {{{"site:hole", "effect:site_place.dx", 0.05}, {"site:hole", "effect:site_place.dy", 0.1}}});
  mjData& d = *machine.data;
  d.qpos[0] = 0.7, d.ctrl[0] = 3;
  mj_forward(machine.model.get(), &d);
  const double radius = std::hypot(0.25, 0.1), angle = 0.7 + std::atan2(0.1, 0.25);
  const double length = std::sqrt(0.4 * 0.4 + radius * radius - 2 * 0.4 * radius * std::cos(angle));
  EXPECT_NEAR(d.ten_length[0], length, 1e-15);
  EXPECT_NEAR(d.qfrc_actuator[0], -3 * 0.4 * radius * std::sin(angle) / length, 1e-14);
}

// A servo on a drum turns the joint by its angle over the gear, with its torque times the gear.
TEST_F(NativeEffect, DrumRadiusScalesLengthAndForceOfAnActuator) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("drum.xml", R"(<mujoco><worldbody><body>
      <joint name="j"/><geom size=".1"/></body></worldbody>
      <actuator><position name="u" joint="j" kp="5" gear="2"/></actuator></mujoco>)"));
  const ModelAndData machine = system.Build({{{"actuator:u", "effect:drum_radius", 1.5}}});
  mjData& d = *machine.data;
  d.qpos[0] = 0.1, d.ctrl[0] = 0.7;
  mj_forward(machine.model.get(), &d);
  EXPECT_NEAR(d.actuator_length[0], 3 * 0.1, 1e-15);
  EXPECT_NEAR(d.qfrc_actuator[0], 3 * 5 * (0.7 - 3 * 0.1), 1e-14);
}

// I q'' = r k_p (u − r q) − b q' swings about u/r. What the motor gives reaches the joint.
TEST_F(NativeEffect, AServoOnADrumSwingsAsItsEquationSays) {
  const ModelSpec system = ModelSpec::Load(scratch_.Write("swing.xml", R"(<mujoco>
      <option gravity="0 0 0" timestep="1e-3" integrator="RK4"/><worldbody><body>
      <joint name="j" damping="0.2"/><inertial pos="0 0 0" mass="1" diaginertia=".05 .05 .05"/></body>
      </worldbody><actuator><position name="u" joint="j" kp="6"/></actuator></mujoco>)"));
  constexpr double r = 1.3, I = 0.05, kp = 6, b = 0.2, u = 0.4;
  const ModelAndData machine = system.Build({{{"actuator:u", "effect:drum_radius", r}}});
  mjData& d = *machine.data;
  d.ctrl[0] = u;
  const double fade = b / (2 * I), w = std::sqrt(r * r * kp / I - fade * fade);
  for (const double time : {0.1, 0.3, 0.8}) {
    while (d.time < time - 1e-9) mj_step(machine.model.get(), &d);
    const double swing = std::cos(w * time) + fade / w * std::sin(w * time);
    EXPECT_NEAR(d.qpos[0], u / r * (1 - std::exp(-fade * time) * swing), 1e-8);
    mj_forward(machine.model.get(), &d);
    EXPECT_NEAR(d.actuator_force[0] * d.actuator_velocity[0], d.qfrc_actuator[0] * d.qvel[0],
                1e-14);
  }
}

TEST_F(NativeEffect, LinkMassScalesMassAndInertiaAboutTheSameCentre) {
  const ModelSpec system = Load();
  const ModelAndData plain = system.Build(),
                     heavy = system.Build({{{"body:link", "effect:link_mass", 1.5}}});
  EXPECT_DOUBLE_EQ(heavy.model->body_mass[1], 0.6);
  for (int i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(heavy.model->body_inertia[3 + i], 1.5 * plain.model->body_inertia[3 + i]);
    EXPECT_DOUBLE_EQ(heavy.model->body_ipos[3 + i], plain.model->body_ipos[3 + i]);
  }
  EXPECT_EQ(system.Value("body:link", "effect:link_mass"), 1);
}

TEST_F(NativeEffect, WhatScalesABodyDoesNotScaleAKnownWeightOnIt) {
  const ModelSpec system = Load();
  const Change weight{"body:link", "point_mass", 0.2}, scale{"body:link", "effect:link_mass", 1.5};
  for (const auto& changes : {std::array{weight, scale}, std::array{scale, weight}})
    EXPECT_DOUBLE_EQ(system.Build(changes).model->body_mass[1], 1.5 * 0.4 + 0.2);
  EXPECT_EQ(system.ValueAfter({{weight, scale}}, "body:link", "point_mass"), 0.2);
}

TEST_F(NativeEffect, ExternalForceActsInWorldAxesAtTheOriginOrASite) {
  const ModelSpec system = Load();
  const double force[3] = {0.3, -0.5, 4};
  // The centre of mass lies 0.1 m along x from the origin, the site 0.1 m further.
  for (const auto& [target, x] : {std::pair{"body:link", -0.1}, {"site:tip", 0.1}}) {
    const ModelAndData machine = Forward(system, {{target, "effect:external_force.fx", force[0]},
                                                  {target, "effect:external_force.fy", force[1]},
                                                  {target, "effect:external_force.fz", force[2]}});
    const mjModel& m = *machine.model;
    mjData& d = *machine.data;
    mj_rnePostConstraint(&m, &d);
    double a[6];  // of the centre of mass, as an accelerometer feels it: spin, then linear
    mj_objectAcceleration(&m, &d, mjOBJ_BODY, 1, a, 0);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(0.4 * a[3 + i], force[i], 1e-12);

    const double arm[3] = {x, 0, 0};
    double torque[3], spin[3], local[3];
    mju_cross(torque, arm, force);
    mju_mulMatTVec3(spin, d.ximat + 9, a);
    mju_mulMatTVec3(local, d.ximat + 9, torque);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(spin[i] * m.body_inertia[3 + i], local[i], 1e-12);
  }
}

TEST_F(NativeEffect, ExternalForceLeavesNothingBehind) {
  const ModelSpec system = Load();
  const std::string before = system.Xml();
  const std::vector<Change> push{{"body:link", "effect:external_force.fy", 1}};
  EXPECT_EQ(system.Build(push).model->nu, 1);
  EXPECT_THAT(system.Xml(push), HasSubstr("external_force_body_link"));
  EXPECT_EQ(system.Build().model->nu, 0);
  EXPECT_EQ(system.Xml(), before);
}

TEST_F(NativeEffect, ExternalForceOfAnExtendedModelRunsByItselfAndAddsUp) {
  const ModelSpec system = Load();
  const std::vector<Change> push{{"body:link", "effect:external_force.fy", 1}};
  const ModelSpec extended = system.With(push, {});
  EXPECT_EQ(Run(extended.Build()), Run(system.Build(push)));
  const ModelAndData twice = Forward(extended, {{"body:link", "effect:external_force.fy", 0.5}});
  EXPECT_EQ(twice.model->nu, 1);
  EXPECT_NEAR(twice.data->qfrc_actuator[1], 1.5, 1e-12);
  EXPECT_NEAR(Forward(extended, {}).data->qfrc_actuator[1], 1, 1e-12);
}

TEST_F(NativeEffect, AtTheirNullTheModelMovesBitByBitAsBefore) {
  const ModelSpec system = Load();
  const auto plain = Run(system.Build());
  for (const Change& change :
       {Change{"body:link", "effect:link_mass", 1}, Change{"body:link", "effect:link_length", 1},
        Change{"body:link", "effect:mounting_angle.yaw", 0},
        Change{"site:tip", "effect:site_place", 0}, Change{"world", "effect:gravity_tilt.pitch", 0},
        Change{"body:link", "effect:external_force", 0},
        Change{"site:tip", "effect:external_force.fz", 0}}) {
    EXPECT_EQ(Run(system.Build({{change}})), plain) << change.attribute;
  }
}

TEST_F(NativeEffect, ErrorsNameEffectAndParameter) {
  const ModelSpec system = Load();
  EXPECT_THAT(Message(system, {"world", "effect:gravity_tilt.yaw", 1}),
              HasSubstr("roll, pitch, found 'yaw'"));
  EXPECT_THAT(Message(system, {"body:link", "effect:dahl", 1}), HasSubstr("a native effect"));
  EXPECT_THAT(Message(system, {"body:link", "effect:gravity_tilt", 1}), Not(HasSubstr("no error")));
  EXPECT_THAT(Message(system, {"world", "effect:link_mass", 2}), HasSubstr("gravity[i]"));
}

}  // namespace
}  // namespace continuum
