#include <algorithm>

#include "hidden_effects/outside/link_chain.h"
#include "hidden_effects/outside/native.h"
#include "hidden_effects/outside/signals.h"
#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

constexpr double kServo = 25, kBrake = 0.6, kMost = 9;  // N m/rad, N m s/rad, N m

constexpr const char* kModel = R"(<mujoco model="two-link arm on servos">
  <compiler angle="radian"/>
  <option timestep="0.002" integrator="implicitfast"/>
  <worldbody>
    <body name="base" quat="0.7071067811865476 0 0.7071067811865476 0">
      <body name="link1">
        <joint name="q1" axis="0 -1 0" damping="0.3" armature="0.02"/>
        <inertial pos="0.14 0 0" mass="1.1" diaginertia="3e-4 0.009 0.009"/>
        <body name="link2" pos="0.3 0 0">
          <joint name="q2" axis="0 -1 0" damping="0.3" armature="0.02"/>
          <inertial pos="0.12 0 0" mass="0.6" diaginertia="2e-4 0.004 0.004"/>
          <body name="tip" pos="0.26 0 0">
            <inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="servo1" joint="q1" kp="25" kv="0.6" forcerange="-9 9"/>
    <position name="servo2" joint="q2" kp="25" kv="0.6" forcerange="-9 9"/>
  </actuator>
  <sensor>
    <jointpos name="q1" joint="q1"/>
    <jointpos name="q2" joint="q2"/>
  </sensor>
</mujoco>
)";

constexpr const char* kExperiment = R"(inputs:
  - {column: goal1, unit: rad, actuator: servo1}
  - {column: goal2, unit: rad, actuator: servo2}
outputs:
  - {column: q1, unit: rad, sensor: q1}
  - {column: q2, unit: rad, sensor: q2}
parameters:
  - {name: damping, target: "joint:*", attribute: damping, initial: 0.35, lower: 0, upper: 3}
  - {name: mass, target: "body:link[12]", attribute: mass, operation: scale, initial: 1, lower: 0.95, upper: 1.05}
)";

/// Two links on position servos with a limit; angles from hanging, each link's against the one
/// before [rad].
struct TwoLink : Outside {
  using Two = Joints<2>::Vector;
  double payload = 0, armature = 0, gap = 0;
  std::array<DryFriction, 2> friction = {};

  Columns Run(const Columns& u, int) const {
    if (law == Law::kNative) {
      return RunNative(
          {kModel, heavier, longer, {friction[0].tau_c, friction[1].tau_c}, {0, 0}, {0, 0}}, u);
    }
    Machine machine(*this);
    return Record(signals, machine, u);
  }

 private:
  struct Machine {
    explicit Machine(const TwoLink& arm) : p(arm) {
      const double l = p.longer, m = p.heavier;
      chain.l << 0.3 * l, 0.26 * l;
      chain.c << 0.14 * l, 0.12 * l;
      chain.m << 1.1 * m, 0.6 * m;
      chain.I << 0.009 * m * l * l, 0.004 * m * l * l;
      chain.armature.setConstant(0.02 + p.armature);
      chain.payload = p.payload;
      chain.Prepare();
      joints.law = p.law, joints.friction = p.friction;
    }
    void Step(const std::vector<double>& u, double h) {
      joints.q += h / 2 * joints.v;
      Two servo;
      for (int j = 0; j < 2; ++j) {
        const double play = u[j] - joints.q[j], half = p.gap / 2;
        const double error = play > half ? play - half : play < -half ? play + half : 0;
        servo[j] = std::clamp(kServo * error - kBrake * joints.v[j], -kMost, kMost);
      }
      const Two gravity = chain.Gravity(joints.q);
      joints.Push(chain.Inertia(joints.q), servo + gravity + chain.Centrifugal(joints.q, joints.v),
                  Two(0.3, 0.3), (servo - gravity).cwiseAbs() / 2, h);
      joints.q += h / 2 * joints.v;
    }
    std::vector<double> Outputs() const { return {joints.q[0], joints.q[1]}; }

    const TwoLink& p;
    LinkChain<2> chain;
    Joints<2> joints;
  };
};

const std::vector<Part<TwoLink>> kParts{
    {{"payload", "mass", 0.08}, [](TwoLink& p, double v) { p.payload = v; }},
    {{"armature", "armature", 0.02, 0.02}, [](TwoLink& p, double v) { p.armature = v; }},
    {{"coulomb", "tau_c", 0.2},
     [](TwoLink& p, double v) { p.friction[0].tau_c = p.friction[1].tau_c = v; }},
    {{"one joint", "", 1}, [](TwoLink& p, double) { p.friction[1] = {}; }},
    {{"directional_friction", "tau_c_plus", 0.3},
     [](TwoLink& p, double v) {
       for (auto& f : p.friction) f.tau_c = v / 1.5, f.lean = 0.5;
     }},
    {{"load_friction", "mu_l", 0.1},
     [](TwoLink& p, double v) { p.friction[0].mu = p.friction[1].mu = v; }},
    {{"stribeck", "tau_c", 0.2},
     [](TwoLink& p, double v) {
       for (auto& f : p.friction) f.tau_c = v, f.S = 0.8;
     }},
    {{"backlash", "gap", 0.02}, [](TwoLink& p, double v) { p.gap = v; }},
    {{"dead_time", "delay", 0.015, 0, {"sensor_delay"}},
     [](TwoLink& p, double v) { p.signals.dead_time = v; }},
    {{"pt1", "T", 0.015}, [](TwoLink& p, double v) { p.signals.lag = v; }},
    {{"sensor_bias", "bias", 0.01}, [](TwoLink& p, double v) { p.signals.bias = v; }},
    {{"sensor_delay", "delay", 0.008, 0, {"dead_time"}},
     [](TwoLink& p, double v) { p.signals.late = v; }},
};

}  // namespace

Robot TwoLinkRobot() {
  Robot robot{"two_link",   kModel,       kExperiment, {"goal1", "goal2"},
              {"q1", "q2"}, {1e-3, 1e-3}, kRowPeriod};
  robot.trials = 4;
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    Columns u;
    for (const double high : {0.8, 0.6})
      u.push_back(StepsAndSines(trial % 3, high, rows, kRowPeriod, rng));
    return u;
  };
  EquipOutside(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
