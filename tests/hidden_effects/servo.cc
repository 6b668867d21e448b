#include <algorithm>
#include <array>
#include <cmath>

#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

constexpr double kPeriod = 0.01;  // s
// Of the firmware's gains 200, 400 and 800.
constexpr std::array kGain{0.382888, 0.765776, 1.531552};  // N m/rad

/// A position servo swings a pendulum; angle q [rad] from hanging, goal u [rad]:
///
///   J q'' = clamp(k_p (u − q), ±τ_max) − k_e q' − d q' − m g l sin q − τ_f
///
/// Symplectic Euler at 25 us; dry friction as an impulse that stops the joint exactly.
struct Servo {
  // As its model knows it; models/servo_pendulum/README.md has the sources.
  double m = 0.49, l = 0.1, i = 1e-6, rotor = 0.00173;     // kg, m, kg m², kg m²
  double k_e = 0.027243, d = 0.00782, tau_max = 0.665341;  // N m s/rad, N m s/rad, N m

  // What may be hidden, absent by default.
  double payload = 0, armature = 0, viscous = 0;                 // kg, kg m², N m s/rad
  double tau_c = 0, stribeck = 0, v_d = 0.3;                     // N m, 1, rad/s
  double load = 0, turning = 0;                                  // 1, N m: turning (1 + sin q)
  double dahl = 0, dahl_stiffness = 5;                           // N m, N m/rad
  double gap = 0, dead_time = 0, gain = 1, offset = 0, lag = 0;  // rad, s, 1, rad, s
  double bias = 0;                                               // rad, at the sensor

  Columns Run(const Columns& u, int trial) const {
    constexpr long kSteps = 400;
    constexpr double h = kPeriod / kSteps;
    const long late = std::lround(dead_time / h);
    double q = 0, v = 0, bristle = 0, goal = gain * u[0][0] + offset;
    Columns out(1);
    for (std::size_t row = 0; row < u[0].size(); ++row) {
      out[0].push_back(q + bias);
      for (long s = 0; s < kSteps; ++s) {
        const double wanted =
            gain * Held(u[0], static_cast<long>(row) * kSteps + s, late, kSteps) + offset;
        goal = lag > 0 ? goal + (1 - std::exp(-h / lag)) * (wanted - goal) : wanted;
        Step(q, v, bristle, goal, kGain[trial], h);
      }
    }
    return out;
  }

 private:
  void Step(double& q, double& v, double& bristle, double goal, double k_p, double h) const {
    const double slack = goal - q, half = gap / 2;
    const double error = slack > half ? slack - half : slack < -half ? slack + half : 0;
    const double motor = std::clamp(k_p * error, -tau_max, tau_max) - k_e * v;
    const double inertia = (m + payload) * l * l + i + rotor + armature;
    double torque = motor - (d + viscous) * v - (m + payload) * 9.81 * l * std::sin(q);
    if (dahl > 0) {
      bristle += h * v * dahl_stiffness * (1 - bristle / dahl * (v > 0 ? 1 : -1));
      torque -= bristle;
    }
    const double slow = v / v_d;
    const double level = tau_c * (1 + stribeck * std::exp(-slow * slow)) + load * std::abs(motor) +
                         turning * (1 + std::sin(q));
    const double free = v + h * torque / inertia, most = h * level / inertia;
    v = free - std::clamp(free, -most, most);
    q += h * v;
  }
};

constexpr const char* kModel = R"(<mujoco model="servo">
  <option timestep="0.0025" integrator="implicitfast"/>
  <worldbody>
    <body name="pendulum">
      <joint name="q" axis="0 1 0" armature="0.00173" damping="0.00782"/>
      <inertial pos="0 0 -0.1" mass="0.49" diaginertia="1e-6 1e-6 1e-6"/>
      <body name="tip" pos="0 0 -0.1">
        <inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="servo" joint="q" kp="0.191444" forcerange="-0.665341 0.665341"/>
    <general name="back_emf" joint="q" gainprm="0" biastype="affine" biasprm="0 0 -0.027243"/>
  </actuator>
  <sensor>
    <jointpos name="q" joint="q"/>
  </sensor>
</mujoco>
)";

constexpr const char* kExperiment = R"(inputs:
  - {column: goal, unit: rad, actuator: servo}
outputs:
  - {column: q, unit: rad, sensor: q}
parameters:
  - {name: torque, target: "actuator:servo", attribute: force_scale, operation: scale, initial: 0.97,
     lower: 0.3, upper: 3}
)";

const std::vector<Part<Servo>> kParts{
    {{"coulomb", "tau_c", 0.005}, [](Servo& s, double v) { s.tau_c = v; }},
    {{"stribeck", "tau_c", 0.005}, [](Servo& s, double v) { s.tau_c = v, s.stribeck = 1; }},
    {{"load_friction", "mu_l", 0.04}, [](Servo& s, double v) { s.load = v; }},
    {{"position_friction", "s", 0.006}, [](Servo& s, double v) { s.turning = v; }},
    {{"dahl", "f", 0.01}, [](Servo& s, double v) { s.dahl = v; }},
    {{"backlash", "gap", 0.02}, [](Servo& s, double v) { s.gap = v; }},
    {{"dead_time", "delay", 0.005}, [](Servo& s, double v) { s.dead_time = v; }},
    {{"pt1", "T", 0.005}, [](Servo& s, double v) { s.lag = v; }},
    {{"payload", "mass", 0.01}, [](Servo& s, double v) { s.payload = v; }},
    {{"armature", "armature", 0.0002, 0.00173}, [](Servo& s, double v) { s.armature = v; }},
    {{"viscous", "b", 0.002}, [](Servo& s, double v) { s.viscous = v; }},
    {{"input_gain", "gain", 0.01, 1}, [](Servo& s, double v) { s.gain = 1 + v; }},
    {{"input_offset", "offset", 0.005}, [](Servo& s, double v) { s.offset = v; }},
    {{"sensor_bias", "bias", 0.003}, [](Servo& s, double v) { s.bias = v; }},
};

std::string Condition(double gain) {
  return "set: {\"actuator:servo\": {kp: " + std::to_string(gain) + "}}";
}

}  // namespace

Robot ServoRobot() {
  Robot robot{"servo", kModel, kExperiment, {"goal"}, {"q"}, {1e-3}, kPeriod};
  for (const double gain : kGain) robot.conditions.push_back(Condition(gain));
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    return Columns{StepsAndSines(trial, 1, rows, kPeriod, rng)};
  };
  Equip(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
