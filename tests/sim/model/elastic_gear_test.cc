#include "sim/model/elastic_gear.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "error.h"
#include "sim/model/model_spec.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

constexpr double kMotor = 0.03, kLink = 0.02, kSpring = 40;  // kg m², N m/rad

// A wheel on a motor or a servo; its armature is the motor's inertia.
std::string Wheel(const std::string& actuator = "<motor name='u' joint='q'/>",
                  const std::string& joint = "", const std::string& option = "timestep='1e-4'",
                  const std::string& more = "") {
  return fmt::format(
      "<mujoco><option gravity='0 0 0' {}/><default><joint damping='0.01'/></default><worldbody>"
      "<body name='wheel'><joint name='q' axis='0 0 1' armature='{}' {}/><inertial pos='0 0 0' "
      "mass='1' diaginertia='1 1 {}'/></body></worldbody><actuator>{}</actuator><sensor><jointpos "
      "name='q' joint='q'/></sensor>{}</mujoco>",
      option, kMotor, joint.empty() ? "damping='0'" : joint, kLink, actuator, more);
}

std::vector<Change> Gear(double compliance, double damping = 0, double gap = 0) {
  return {{"joint:q", "effect:elastic_gear.c", compliance},
          {"joint:q", "effect:elastic_gear.d", damping},
          {"joint:q", "effect:elastic_gear.gap", gap}};
}

// Motor and wheel, and a servo on the motor, from other equations and another integrator
// (Runge and Kutta's of the fourth order):
//
//   J θ'' = k_p (u − θ) − τ,   I q'' = τ − b q',   τ = k z(θ − q) + d (θ' − q')
struct TwoWheels {
  double kp = 0, u = 0, d = 0, b = 0, gap = 0;
  using State = Eigen::Vector4d;  // θ, q, θ', q'

  State Rate(const State& y) const {
    const double e = y[0] - y[1], half = gap / 2;
    const double stretch = e > half ? e - half : e < -half ? e + half : 0;
    const double torque = kSpring * stretch + d * (y[2] - y[3]);
    return {y[2], y[3], (kp * (u - y[0]) - torque) / kMotor, (torque - b * y[3]) / kLink};
  }
  State After(double time, State y) const {
    constexpr double h = 1e-5;
    for (long n = std::lround(time / h); n > 0; --n) {
      const State k1 = Rate(y), k2 = Rate(y + h / 2 * k1), k3 = Rate(y + h / 2 * k2),
                  k4 = Rate(y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return y;
  }
};

void RunUntil(const ModelAndData& machine, double time) {
  while (machine.data->time < time - 1e-9) mj_step(machine.model.get(), machine.data.get());
}

// Free wheels that a spring joins swing at ω² = k (1/J + 1/I): cosines about their common turn.
TEST(ElasticGear, MotorAndJointSwingAtTheirFrequency) {
  const ModelAndData machine = ModelSpec::Parse(Wheel()).Build(Gear(1 / kSpring));
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  ASSERT_EQ(m.nv, 2);
  ASSERT_EQ(GearMotorOf(m, 0), 1);
  const double w = std::sqrt(kSpring * (1 / kMotor + 1 / kLink)), start = 0.1;
  d.qpos[1] = start;  // the motor, wound up
  const double mean = start * kMotor / (kMotor + kLink);
  for (const double time : {0.02, 0.05, 0.1}) {
    RunUntil(machine, time);
    const double q = mean * (1 - std::cos(w * time)),
                 motor = mean + start * kLink / (kMotor + kLink) * std::cos(w * time);
    // Half a step late or early: h ω times the amplitude.
    EXPECT_NEAR(d.qpos[0], q, start * w * 1e-4);
    EXPECT_NEAR(d.qpos[1], motor, start * w * 1e-4);
  }
}

TEST(ElasticGear, KeepsItsEnergy) {
  const std::string rk4 = "timestep='1e-3' integrator='RK4'";
  const ModelAndData machine =
      ModelSpec::Parse(Wheel("<motor name='u' joint='q'/>", "", rk4)).Build(Gear(1 / kSpring));
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  machine.model->opt.enableflags |= mjENBL_ENERGY;
  d.qpos[1] = 0.1;
  mj_forward(&m, &d);
  const double energy = d.energy[0] + d.energy[1];
  EXPECT_NEAR(energy, 0.5 * kSpring * 0.1 * 0.1, 1e-12);
  RunUntil(machine, 1);
  mj_forward(&m, &d);
  EXPECT_NEAR(d.energy[0] + d.energy[1], energy, 1e-5 * energy);  // (h ω)^5/144 a step
}

TEST(ElasticGear, AServoTurnsAJointThroughSpringDamperAndPlay) {
  for (const double gap : {0.0, 0.03}) {
    const ModelAndData machine =
        ModelSpec::Parse(Wheel("<position name='u' joint='q' kp='8'/>", "damping='0.05'",
                               "timestep='1e-4' integrator='RK4'"))
            .Build(Gear(1 / kSpring, 0.04, gap));
    mjData& d = *machine.data;
    d.ctrl[0] = 0.5;
    const TwoWheels wheels{.kp = 8, .u = 0.5, .d = 0.04, .b = 0.05, .gap = gap};
    for (const double time : {0.05, 0.3, 1.0}) {
      RunUntil(machine, time);
      const auto y = wheels.After(time, TwoWheels::State::Zero());
      EXPECT_NEAR(d.qpos[1], y[0], 1e-6) << gap << " " << time;
      EXPECT_NEAR(d.qpos[0], y[1], 1e-6) << gap << " " << time;
    }
  }
}

// Free wheels with play rattle: 2 (gap/w + π/ω), play crossed at w and half swings at its ends.
TEST(ElasticGear, FreeWheelsRattleInTheirPlayWithTheirPeriodAndEnergy) {
  constexpr double kGap = 0.04, kSpeed = 0.6;
  const ModelAndData machine =
      ModelSpec::Parse(Wheel("<motor name='u' joint='q'/>", "", "timestep='1e-4' integrator='RK4'"))
          .Build(Gear(1 / kSpring, 0, kGap));
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  machine.model->opt.enableflags |= mjENBL_ENERGY;
  d.qvel[1] = kSpeed;
  const double w = std::sqrt(kSpring * (1 / kMotor + 1 / kLink)),
               period = 2 * (kGap / kSpeed + M_PI / w), mean = kSpeed * kMotor / (kMotor + kLink);
  for (int turn = 1; turn <= 5; ++turn) {
    RunUntil(machine, turn * period);
    mj_forward(&m, &d);
    EXPECT_NEAR(d.qpos[1] - d.qpos[0], kSpeed * (d.time - turn * period), 1e-4 * kGap) << turn;
    EXPECT_NEAR(d.qpos[0], mean * turn * period, 1e-5) << turn;
    EXPECT_NEAR(d.energy[0] + d.energy[1], 0.5 * kMotor * kSpeed * kSpeed, 1e-7) << turn;
  }
}

// Held by dry friction the motor winds up play and spring, gap/2 + c τ; at more the joint turns.
TEST(ElasticGear, WindsUpBeforeTheJointBreaksAway) {
  constexpr double kGap = 0.04, kFriction = 0.8;
  const ModelSpec wheel = ModelSpec::Parse(
      Wheel("<motor name='u' joint='q'/>", "", "timestep='1e-3' integrator='implicitfast'",
            "<extension><plugin plugin='continuum.coulomb'><instance name='f'><config key='joint' "
            "value='q'/><config key='tau_c' value='0.8'/></instance></plugin></extension>"));
  for (const double share : {0.5, 0.97, 1.03}) {
    const ModelAndData machine = wheel.Build(Gear(1 / kSpring, 0.3, kGap));
    mjData& d = *machine.data;
    const double torque = share * kFriction;
    const auto ramp = [&](double until) {
      while (d.time < until - 1e-9) {
        d.ctrl[0] = torque * std::min(1.0, d.time / 4);
        mj_step(machine.model.get(), &d);
      }
    };
    ramp(8);
    const double held = d.qpos[0], wound = d.qpos[1] - held;
    ramp(10);
    if (share < 1) {
      EXPECT_NEAR(held, 0, 1e-4) << share;
      EXPECT_NEAR(wound, kGap / 2 + torque / kSpring, 1e-4) << share;
      EXPECT_NEAR(d.qpos[0], held, 1e-8) << share;
    } else {
      EXPECT_GT(d.qpos[0], 0.1);
    }
  }
}

// As it gets stiffer it goes over into the joint with its armature, and beyond what steps show it
// is that joint.
TEST(ElasticGear, AStiffOneIsTheArmatureOfTheJoint) {
  const ModelSpec wheel = ModelSpec::Parse(Wheel());
  const auto turned = [&](const std::vector<Change>& changes) {
    const ModelAndData machine = wheel.Build(changes);
    machine.data->ctrl[0] = 0.3;
    RunUntil(machine, 0.2);
    return machine.data->qpos[0];
  };
  const double rigid = turned({});
  double last = 1;
  for (const double c : {1e-2, 1e-3, 1e-4}) {
    const double error = std::abs(turned(Gear(c)) - rigid);
    EXPECT_LT(error, 0.5 * last) << c;
    last = error;
  }
  EXPECT_LT(last, 1e-4 * rigid);
  EXPECT_EQ(wheel.Build(Gear(1e-9)).model->nv, 1);
  EXPECT_EQ(turned(Gear(1e-9)), rigid);
  EXPECT_EQ(turned(Gear(0)), rigid);
}

TEST(ElasticGear, LeavesNothingBehind) {
  const std::string key = "<keyframe><key name='k' qpos='0.3' qvel='0.1' ctrl='0.2'/></keyframe>";
  const ModelSpec wheel =
      ModelSpec::Parse(Wheel("<motor name='u' joint='q'/>", "ref='0.1' damping='0'", "", key));
  const std::string before = wheel.Xml();
  const ModelAndData soft = wheel.Build(Gear(0.05, 0.01, 0.02));
  ASSERT_EQ(soft.model->nq, 2);
  EXPECT_EQ(soft.model->key_qpos[1], 0.3);
  EXPECT_EQ(soft.model->key_qvel[1], 0.1);
  EXPECT_EQ(soft.model->qpos0[1], soft.model->qpos0[0]);
  EXPECT_EQ(wheel.Build().model->nq, 1);
  EXPECT_EQ(wheel.Xml(), before);
}

// The motor's numbers come after those of what its joint carries, before those of other robots.
TEST(ElasticGear, KeyframesOfSeveralRobotsKeepTheirOrder) {
  const std::string link = "<geom size='0.1' mass='1' contype='0'/>";
  const ModelSpec robots = ModelSpec::Parse(
      "<mujoco><worldbody><body><joint name='a' armature='0.1'/>" + link +
      "<body><joint name='b'/>" + link + "</body></body><body><joint name='c'/>" + link +
      "</body></worldbody><actuator><motor joint='a'/></actuator><keyframe><key qpos='1 2 3' "
      "qvel='4 5 6'/></keyframe></mujoco>");
  const ModelAndData soft = robots.Build({{{"joint:a", "effect:elastic_gear.c", 1}}});
  const mjModel& m = *soft.model;
  ASSERT_EQ(m.nq, 4);
  const auto value = [&](const mjtNum* key, const std::string& joint) {
    return key[mj_name2id(&m, mjOBJ_JOINT, joint.c_str())];
  };
  for (const auto& [joint, q] : {std::pair{"a", 1.0}, {"b", 2}, {"c", 3}, {".gear_a", 1}}) {
    EXPECT_EQ(value(m.key_qpos, joint), q) << joint;
    EXPECT_EQ(value(m.key_qvel, joint), q == 1 ? 4 : q + 3) << joint;
  }
}

TEST(ElasticGear, AnExtendedModelHasItAndNeedsNoPlugin) {
  const ModelSpec wheel = ModelSpec::Parse(Wheel("<position name='u' joint='q' kp='8'/>"));
  const ModelSpec extended = wheel.With(Gear(0.05, 0.01, 0.02), {});
  EXPECT_EQ(extended.model().nplugin, 0);
  const ModelAndData a = wheel.Build(Gear(0.05, 0.01, 0.02)), b = extended.Build();
  a.data->ctrl[0] = b.data->ctrl[0] = 0.5;
  RunUntil(a, 0.3), RunUntil(b, 0.3);
  EXPECT_NEAR(a.data->qpos[0], b.data->qpos[0], 1e-12);
}

// Globs of the experiment that was fitted mean the same in the extended model.
TEST(ElasticGear, GlobsLeaveItsPartsOut) {
  const ModelSpec extended = ModelSpec::Parse(Wheel()).With(Gear(0.05), {});
  EXPECT_THAT(extended.Named("joint:*"), ::testing::ElementsAre("joint 'q'"));
  EXPECT_THAT(extended.Named("joint:.gear_q"), ::testing::ElementsAre("joint '.gear_q'"));
}

TEST(ElasticGear, TheArmatureIsTheMotorsBeforeAndAfter) {
  const ModelSpec wheel = ModelSpec::Parse(Wheel());
  std::vector<Change> changes = Gear(0.05);
  changes.push_back({"joint:q", "armature", 0.07});
  const ModelSpec extended = wheel.With(Gear(0.05), {});
  const ModelAndData both = wheel.Build(changes), later = extended.Build({{changes.back()}});
  for (const mjModel* const m : {both.model.get(), later.model.get()}) {
    EXPECT_EQ(m->dof_armature[0], 0);
    EXPECT_EQ(m->dof_armature[1], 0.07);
  }
  EXPECT_EQ(extended.Value("joint:q", "armature"), kMotor);
  EXPECT_EQ(extended.Build().model->dof_armature[1], kMotor);
}

TEST(ElasticGear, MotorsFollowJointsThatArePutElsewhere) {
  const ModelAndData machine = ModelSpec::Parse(Wheel()).Build(Gear(0.05));
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  d.qpos[0] = 0.1, d.qpos[1] = 0.15, d.qvel[1] = 2;
  PlaceJoint(m, d, 0, 0.4, 1);
  EXPECT_DOUBLE_EQ(d.qpos[1], 0.45);
  EXPECT_DOUBLE_EQ(d.qvel[1], 3);
  FollowGears(m, d.qpos, d.qvel);
  EXPECT_EQ(d.qpos[1], 0.4);
  EXPECT_EQ(d.qvel[1], 1);
}

TEST(ElasticGear, SaysWhatAJointLacks) {
  const auto message = [](const std::string& xml) {
    try {
      ModelSpec::Parse(xml).Build(Gear(0.05));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message(Wheel("")), HasSubstr("an actuator that an elastic gear passes on"));
  std::string light = Wheel();
  light.replace(light.find("armature='0.03'"), 15, "armature='0'");
  EXPECT_THAT(message(light), HasSubstr("joint 'q': armature"));
  EXPECT_THAT(message(light), HasSubstr("the inertia of the motor"));
}

// A spring or damper below zero creates energy.
TEST(ElasticGear, RefusesWhatCreatesEnergy) {
  const ModelSpec wheel = ModelSpec::Parse(Wheel()), extended = wheel.With(Gear(0.05), {});
  const auto message = [](const ModelSpec& model, std::vector<Change> changes) {
    try {
      model.Build(changes);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  for (const std::string attribute : {"gear_compliance", "gear_damping", "gear_play"}) {
    for (const ModelSpec* const model : {&wheel, &extended}) {
      EXPECT_THAT(message(*model, {{"joint:q", attribute, -0.1}}),
                  HasSubstr("joint 'q': " + attribute + ": expected a number >= 0, found -0.1"));
    }
  }
  EXPECT_EQ(message(wheel, {{"joint:q", "gear_compliance", 0}}), "no error");
  EXPECT_THAT(message(extended, {{"joint:q", "gear_compliance", 0}}),
              HasSubstr("joint 'q': gear_compliance: expected a positive number"));
}

}  // namespace
}  // namespace continuum
