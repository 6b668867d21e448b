#include "hidden_effects/outside/link_chain.h"
#include "hidden_effects/outside/native.h"
#include "hidden_effects/outside/signals.h"
#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

// Angle [rad] and speed [rad/s] at which each trial is let go; the second one starts a whole turn.
constexpr double kStart[][2] = {{1.2, 0}, {2.7, 4.5}, {-0.6, 0}, {-2.4, -1}};

constexpr const char* kModel = R"(<mujoco model="pendulum">
  <compiler angle="radian"/>
  <option timestep="0.001" integrator="implicitfast"/>
  <worldbody>
    <body name="base" quat="0.7071067811865476 0 0.7071067811865476 0">
      <body name="link">
        <joint name="q" axis="0 -1 0" damping="0.04" armature="0.008"/>
        <inertial pos="0.15 0 0" mass="0.5" diaginertia="1e-4 0.004 0.004"/>
        <body name="tip" pos="0.3 0 0">
          <inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="motor" joint="q"/>
  </actuator>
  <sensor>
    <jointpos name="q" joint="q"/>
  </sensor>
</mujoco>
)";

constexpr const char* kExperiment = R"(inputs:
  - {column: u, unit: N*m, actuator: motor, enable: enable}
outputs:
  - {column: q, unit: rad, sensor: q}
parameters:
  - {name: damping, target: "joint:q", attribute: damping, initial: 0.05, lower: 0, upper: 0.5}
  - {name: mass, target: "body:link", attribute: mass, operation: scale, initial: 1, lower: 0.95, upper: 1.05}
)";

/// A pendulum whose motor is switched on and off; angle from hanging [rad], torque [N m].
struct Pendulum : Outside {
  using One = Joints<1>::Vector;
  double payload = 0, armature = 0.008, damping = 0.04;
  DryFriction friction;
  bool sees_load = false;

  Columns Run(const Columns& u, int trial) const {
    if (law == Law::kNative) {
      Columns torque{u[0]};
      for (std::size_t k = 0; k < u[0].size(); ++k) torque[0][k] *= u[1][k] > 0.5;
      return RunNative(
          {kModel, heavier, longer, {friction.tau_c}, {kStart[trial][0]}, {kStart[trial][1]}},
          torque);
    }
    Machine machine(*this, trial);
    return Record(signals, machine, {u[0]}, u[1]);
  }

 private:
  struct Machine {
    Machine(const Pendulum& p, int trial) : damping(p.damping) {
      const double l = p.longer, m = p.heavier;
      chain.l << 0.3 * l, chain.c << 0.15 * l, chain.m << 0.5 * m, chain.I << 0.004 * m * l * l;
      chain.armature << p.armature;
      chain.payload = p.payload;
      chain.Prepare();
      joint.law = p.law, joint.friction[0] = p.friction;
      joint.q << kStart[trial][0], joint.v << kStart[trial][1];
    }
    void Step(const std::vector<double>& u, double h) {
      joint.q += h / 2 * joint.v;
      const One motor(u[0]), gravity = chain.Gravity(joint.q);
      joint.Push(chain.Inertia(joint.q), motor + gravity, One(damping),
                 (motor - gravity).cwiseAbs() / 2, h);
      joint.q += h / 2 * joint.v;
    }
    std::vector<double> Outputs() const { return {joint.q[0]}; }

    LinkChain<1> chain;
    Joints<1> joint;
    double damping;
  };
};

const std::vector<Part<Pendulum>> kParts{
    {{"payload", "mass", 0.5}, [](Pendulum& p, double v) { p.payload = v; }},
    {{"coulomb", "tau_c", 0.03}, [](Pendulum& p, double v) { p.friction.tau_c = v; }},
    {{"stribeck", "tau_c", 0.03},
     [](Pendulum& p, double v) { p.friction.tau_c = v, p.friction.S = 0.8; }},
    {{"load_friction", "mu_l", 0.08}, [](Pendulum& p, double v) { p.friction.mu = v; }},
    {{"input_offset", "offset", 0.03}, [](Pendulum& p, double v) { p.signals.offset = v; }},
    {{"input_gain", "gain", 0.1, 1}, [](Pendulum& p, double v) { p.signals.gain = 1 + v; }},
    {{"dead_time", "delay", 0.015}, [](Pendulum& p, double v) { p.signals.dead_time = v; }},
    {{"pt1", "T", 0.015}, [](Pendulum& p, double v) { p.signals.lag = v; }},
    {{"armature", "armature", 0.003, 0.008}, [](Pendulum& p, double v) { p.armature += v; }},
    {{"sensor_bias", "bias", 0.02}, [](Pendulum& p, double v) { p.signals.bias = v; }},
    {{"sensor_delay", "delay", 0.008}, [](Pendulum& p, double v) { p.signals.late = v; }},
};

// Torques of steps and sines, and when the motor is on: now and then for a while.
Columns Drive(int trial, std::mt19937_64& rng) {
  constexpr std::size_t kRows = 400;
  std::uniform_real_distribution<double> part;
  Columns u{StepsAndSines(trial, 0.5, kRows, kRowPeriod, rng), {}};
  bool on = false;
  std::size_t next = 30;
  for (std::size_t k = 0; k < kRows; ++k) {
    if (k == next) on = !on, next = k + 25 + static_cast<std::size_t>(60 * part(rng));
    u[1].push_back(on);
  }
  return u;
}

}  // namespace

Robot PendulumRobot() {
  Robot robot{"pendulum", kModel, kExperiment, {"u", "enable"}, {"q"}, {2e-3}, kRowPeriod};
  robot.trials = std::size(kStart);
  for (const auto& [q, v] : kStart) {
    robot.conditions.push_back("start: {q: [" + std::to_string(q) + ", " + std::to_string(v) +
                               "]}");
  }
  robot.drive = Drive;
  EquipOutside(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
