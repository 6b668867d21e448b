#include "hidden_effects/outside/joints.h"
#include "hidden_effects/outside/native.h"
#include "hidden_effects/outside/signals.h"
#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

constexpr double kValve = 0.02;  // s, lag of the valve that the model knows

constexpr const char* kModel = R"(<mujoco model="valve">
  <option timestep="0.002" integrator="implicitfast"/>
  <worldbody>
    <body name="piston">
      <joint name="x" type="slide" axis="1 0 0" stiffness="120" damping="8"/>
      <inertial pos="0 0 0" mass="2" diaginertia="0.01 0.01 0.01"/>
    </body>
  </worldbody>
  <actuator>
    <general name="valve" joint="x" dyntype="filterexact" dynprm="0.02"/>
  </actuator>
  <sensor>
    <jointpos name="x" joint="x"/>
  </sensor>
</mujoco>
)";

constexpr const char* kExperiment = R"(inputs:
  - {column: command, unit: N, actuator: valve}
outputs:
  - {column: x, unit: m, sensor: x}
parameters:
  - {name: stiffness, target: "joint:x", attribute: stiffness, initial: 110, lower: 20, upper: 500}
  - {name: damping, target: "joint:x", attribute: damping, initial: 7, lower: 0, upper: 50}
)";

/// A piston on a spring behind a valve of first order; position [m], command [N].
struct Valve : Outside {
  using One = Joints<1>::Vector;
  double payload = 0, lag = 0, cubic = 0, creep = 0, creep_time = 0.4;
  DryFriction friction;

  Columns Run(const Columns& u, int) const {
    if (law == Law::kNative)
      return RunNative({kModel, heavier, longer, {friction.tau_c}, {0}, {0}}, u);
    Machine machine(*this);
    return Record(signals, machine, u);
  }

 private:
  struct Machine {
    explicit Machine(const Valve& valve) : p(valve) {
      joint.law = p.law, joint.friction[0] = p.friction;
    }
    void Step(const std::vector<double>& u, double h) {
      force_of_valve += (1 - std::exp(-h / (kValve + p.lag))) * (u[0] - force_of_valve);
      joint.q += h / 2 * joint.v;
      const double x = joint.q[0];
      const double force = force_of_valve - 120 * x - p.cubic * x * x * x - p.creep * (x - crept);
      crept += (1 - std::exp(-h / p.creep_time)) * (x - crept);
      joint.Push(Joints<1>::Matrix(2 * p.heavier + p.payload), One(force), One(8), One(0), h);
      joint.q += h / 2 * joint.v;
    }
    std::vector<double> Outputs() const { return {joint.q[0]}; }

    const Valve& p;
    Joints<1> joint;
    double force_of_valve = 0, crept = 0;
  };
};

const std::vector<Part<Valve>> kParts{
    {{"pt1", "T", 0.02}, [](Valve& p, double v) { p.lag = v; }},
    {{"dead_time", "delay", 0.015, 0, {"sensor_delay"}},
     [](Valve& p, double v) { p.signals.dead_time = v; }},
    {{"coulomb", "tau_c", 0.6}, [](Valve& p, double v) { p.friction.tau_c = v; }},
    {{"stribeck", "tau_c", 0.6},
     [](Valve& p, double v) { p.friction.tau_c = v, p.friction.S = 0.8, p.friction.v_s = 0.03; }},
    {{"cubic_stiffness", "k3", 8000}, [](Valve& p, double v) { p.cubic = v; }},
    {{"maxwell", "k_m", 15}, [](Valve& p, double v) { p.creep = v; }},
    {{"payload", "mass", 0.2, 0, {"link_mass"}}, [](Valve& p, double v) { p.payload = v; }},
    {{"input_gain", "gain", 0.05, 1, {"link_mass", "payload", "sensor_scale"}},
     [](Valve& p, double v) { p.signals.gain = 1 + v; }},
    {{"input_offset", "offset", 0.4, 0, {"sensor_bias"}},
     [](Valve& p, double v) { p.signals.offset = v; }},
    {{"sensor_drift", "rate", 0.001}, [](Valve& p, double v) { p.signals.drift = v; }},
    {{"sensor_delay", "delay", 0.01, 0, {"dead_time"}},
     [](Valve& p, double v) { p.signals.late = v; }},
};

}  // namespace

Robot ValveRobot() {
  Robot robot{"valve", kModel, kExperiment, {"command"}, {"x"}, {2e-4}, kRowPeriod};
  robot.trials = 4;
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    return Columns{StepsAndSines(trial % 3, 10, rows, kRowPeriod, rng)};
  };
  EquipOutside(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
