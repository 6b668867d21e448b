#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

constexpr double kPeriod = 0.01;  // s

/// A two-link arm in a vertical plane with springs and motors at its joints, by hand, as the source
/// of logs that MuJoCo had no part in. Angles q1, q2 [rad] from hanging, each link's own against
/// the one before; torques of the motors u [N m]:
///
///   M(q) q'' + c(q, q') + g(q) = G u − K q − D q' − τ_f
///
/// Symplectic Euler at 20 us; dry friction as impulses that stop a joint exactly (projected
/// Gauss-Seidel over both joints).
struct Arm {
  using Pair = std::array<double, 2>;

  // The arm as its model knows it.
  double l1 = 0.3, l2 = 0.25;      // m
  double m1 = 0.5, m2 = 0.3;       // kg, at the middles
  double i1 = 0.004, i2 = 0.0016;  // kg m², about the middles
  double k = 2, d = 0.05;          // N m/rad, N m s/rad

  // What may be hidden, absent by default.
  double payload = 0, link = 1, armature = 0;           // kg, factor on masses, kg m²
  double tau_c = 0, load = 0, turning = 0;              // N m, 1, N m: + c cos q
  double stribeck = 0, v_d = 0.2;                       // 1, rad/s
  double k3 = 0;                                        // N m/rad³
  double k_m = 0, tau_m = 0.3;                          // N m/rad, s
  double gain = 1, offset = 0, dead_time = 0, lag = 0;  // 1, N m, s, s
  double tilt = 0, push = 0;             // rad about the joints' axis, N at the tip along x
  double dahl = 0, dahl_stiffness = 20;  // N m, N m/rad
  // What no effect of the list is.
  double cogging = 0, drag = 0;        // N m at ten a turn, N m s²/rad²
  double coupling = 0, crosstalk = 0;  // N m/rad between the joints, 1: of u1 at joint 2
  double wander = 0, one_sided = 0;    // N m at 0.23 Hz, N m/rad more where q > 0
  // At the sensors of the joint angles.
  double bias = 0, scale = 1, late = 0, drift = 0;  // rad, 1, s, rad/s

  /// Angles and tip positions (x, z) [rad, m] at every row, from rest; inputs held between rows.
  Columns Run(const Columns& u, int) const {
    constexpr double h = 2e-5;
    const int steps = static_cast<int>(std::lround(kPeriod / h));
    const auto behind = static_cast<std::size_t>(std::lround(dead_time / h));
    std::vector<Pair> given;  // what the motors get, step by step
    Pair lagged{gain * u[0][0] + offset, gain * u[1][0] + offset};
    Pair q{0, 0}, v{0, 0}, creep{0, 0}, bristle{0, 0};
    Columns out(4);
    std::vector<Pair> angles;  // every step, for sensors that are late
    for (std::size_t row = 0; row < u[0].size(); ++row) {
      angles.push_back(q);
      const auto& seen = angles[angles.size() - 1 - std::min(angles.size() - 1, Steps(late, h))];
      const double t = kPeriod * static_cast<double>(row);
      for (int j = 0; j < 2; ++j) out[j].push_back(scale * seen[j] + bias + drift * t);
      out[2].push_back(l1 * std::sin(q[0]) + l2 * std::sin(q[0] + q[1]));
      out[3].push_back(-l1 * std::cos(q[0]) - l2 * std::cos(q[0] + q[1]));
      angles.pop_back();
      for (int s = 0; s < steps; ++s) {
        angles.push_back(q);
        given.push_back({u[0][row], u[1][row]});
        const Pair late_input = given[given.size() - 1 - std::min(given.size() - 1, behind)];
        Pair motor;
        for (int j = 0; j < 2; ++j) {
          const double wanted = gain * late_input[j] + offset;
          lagged[j] =
              lag > 0 ? lagged[j] + (1 - std::exp(-h / lag)) * (wanted - lagged[j]) : wanted;
          motor[j] = lagged[j];
        }
        motor[1] += crosstalk * motor[0];
        Step(q, v, creep, bristle, motor, t + h * s, h);
      }
    }
    return out;
  }

 private:
  static std::size_t Steps(double t, double h) {
    return static_cast<std::size_t>(std::lround(t / h));
  }

  void Step(Pair& q, Pair& v, Pair& creep, Pair& bristle, const Pair& motor, double t,
            double h) const {
    const double a1 = link * m1, a2 = link * m2, j1 = link * i1, j2 = link * i2;
    const double tip = payload, c2 = std::cos(q[1]), s2 = std::sin(q[1]);
    const double r1 = l1 / 2, r2 = l2 / 2;
    const double far = a2 * r2 + tip * l2;                  // first moment of the second link
    const double far2 = a2 * r2 * r2 + tip * l2 * l2 + j2;  // second
    const double m22 = far2 + armature;
    const double m12 = far2 + l1 * far * c2;
    const double m11 =
        a1 * r1 * r1 + j1 + (a2 + tip) * l1 * l1 + far2 + 2 * l1 * far * c2 + armature;
    const double coriolis = l1 * far * s2;
    const double gx = 9.81 * std::sin(tilt), gz = 9.81 * std::cos(tilt);  // g = (gx, −gz)
    const double near = a1 * r1 + (a2 + tip) * l1;
    const double s_1 = std::sin(q[0]), c_1 = std::cos(q[0]);
    const double s_12 = std::sin(q[0] + q[1]), c_12 = std::cos(q[0] + q[1]);
    Pair outer;  // all but motors, friction and inertia
    outer[1] = -far * (gz * s_12 - gx * c_12) + push * l2 * c_12 - coriolis * v[0] * v[0];
    outer[0] = -near * (gz * s_1 - gx * c_1) - far * (gz * s_12 - gx * c_12) +
               push * (l1 * c_1 + l2 * c_12) + coriolis * (2 * v[0] + v[1]) * v[1];
    const double sway = wander * std::sin(2 * std::numbers::pi * 0.23 * t);
    outer[0] -= sway + coupling * (q[0] - q[1]);
    outer[1] += sway + coupling * (q[0] - q[1]);
    Pair torque, level;
    for (int j = 0; j < 2; ++j) {
      outer[j] -= k * q[j] + k3 * q[j] * q[j] * q[j];
      outer[j] += cogging * std::sin(10 * q[j]) - drag * v[j] * std::abs(v[j]) -
                  one_sided * std::max(0.0, q[j]);
      if (k_m > 0) {
        outer[j] -= k_m * (q[j] - creep[j]);
        creep[j] += (1 - std::exp(-h / tau_m)) * (q[j] - creep[j]);
      }
      if (dahl > 0) {
        bristle[j] += h * v[j] * dahl_stiffness * (1 - bristle[j] / dahl * (v[j] > 0 ? 1 : -1));
        outer[j] -= bristle[j];
      }
      const double through = std::abs(motor[j] - outer[j]) / 2;
      outer[j] -= d * v[j];
      torque[j] = motor[j] + outer[j];
      const double slow = 1 + stribeck * std::exp(-std::pow(v[j] / v_d, 2));
      level[j] = std::max(0.0, tau_c * slow + load * through + turning * std::cos(q[j]));
    }
    const double det = m11 * m22 - m12 * m12;
    const Pair free{v[0] + h * (m22 * torque[0] - m12 * torque[1]) / det,
                    v[1] + h * (m11 * torque[1] - m12 * torque[0]) / det};
    Pair p{0, 0};
    v = free;
    for (int iteration = 0; iteration < 30; ++iteration) {
      for (int j = 0; j < 2; ++j) {
        const double inverse = (j ? m11 : m22) / det, other = -m12 / det;
        const double now = free[j] + inverse * p[j] + other * p[1 - j];
        p[j] = std::clamp(p[j] - now / inverse, -h * level[j], h * level[j]);
      }
      if (level[0] == 0 && level[1] == 0) break;
    }
    v[0] = free[0] + (m22 * p[0] - m12 * p[1]) / det;
    v[1] = free[1] + (m11 * p[1] - m12 * p[0]) / det;
    for (int j = 0; j < 2; ++j) q[j] += h * v[j];
  }
};

// The same arm as MJCF, with nothing hidden.
constexpr const char* kModel = R"(<mujoco model="two-link arm">
  <option timestep="0.002" integrator="implicitfast"/>
  <worldbody>
    <body name="upper">
      <joint name="q1" axis="0 -1 0" stiffness="2" damping="0.05"/>
      <inertial pos="0 0 -0.15" mass="0.5" diaginertia="0.004 0.004 0.0001"/>
      <body name="lower" pos="0 0 -0.3">
        <joint name="q2" axis="0 -1 0" stiffness="2" damping="0.05"/>
        <inertial pos="0 0 -0.125" mass="0.3" diaginertia="0.0016 0.0016 0.0001"/>
        <body name="tip" pos="0 0 -0.25">
          <inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>
          <site name="tip"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="u1" joint="q1"/>
    <motor name="u2" joint="q2"/>
  </actuator>
  <sensor>
    <jointpos name="q1" joint="q1"/>
    <jointpos name="q2" joint="q2"/>
    <framepos name="tip" objtype="site" objname="tip"/>
  </sensor>
</mujoco>
)";

constexpr const char* kExperiment = R"(inputs:
  - {column: u1, unit: N*m, actuator: u1}
  - {column: u2, unit: N*m, actuator: u2}
outputs:
  - {column: q1, unit: rad, sensor: q1}
  - {column: q2, unit: rad, sensor: q2}
  - {column: x, unit: m, sensor: "tip[0]"}
  - {column: z, unit: m, sensor: "tip[2]"}
parameters:
  - {name: stiffness, target: "joint:*", attribute: stiffness, initial: 1.9, lower: 0.2, upper: 20}
  - {name: damping, target: "joint:*", attribute: damping, initial: 0.06, lower: 0, upper: 1}
)";

const std::vector<Part<Arm>> kParts{
    {{"payload", "mass", 0.004, 0, {"link_mass"}}, [](Arm& a, double v) { a.payload = v; }},
    {{"armature", "armature", 0.0005}, [](Arm& a, double v) { a.armature = v; }},
    {{"coulomb", "tau_c", 0.005}, [](Arm& a, double v) { a.tau_c = v; }},
    {{"load_friction", "mu_l", 0.01}, [](Arm& a, double v) { a.load = v; }},
    {{"dahl", "f", 0.01}, [](Arm& a, double v) { a.dahl = v; }},
    {{"input_gain", "gain", 0.006, 1}, [](Arm& a, double v) { a.gain = 1 + v; }},
    {{"input_offset", "offset", 0.006}, [](Arm& a, double v) { a.offset = v; }},
    {{"dead_time", "delay", 0.004}, [](Arm& a, double v) { a.dead_time = v; }},
    {{"pt1", "T", 0.004}, [](Arm& a, double v) { a.lag = v; }},
    {{"cubic_stiffness", "k3", 0.06}, [](Arm& a, double v) { a.k3 = v; }},
    {{"maxwell", "k_m", 0.05}, [](Arm& a, double v) { a.k_m = v; }},
    {{"link_mass", "scale", 0.01, 1}, [](Arm& a, double v) { a.link = 1 + v; }},
    {{"gravity_tilt", "pitch", 0.004}, [](Arm& a, double v) { a.tilt = -v; }},
    {{"external_force", "fx", 0.02}, [](Arm& a, double v) { a.push = v; }},
    {{"sensor_bias", "bias", 0.001}, [](Arm& a, double v) { a.bias = v; }},
    {{"sensor_scale", "scale", 0.004, 1}, [](Arm& a, double v) { a.scale = 1 + v; }},
    {{"sensor_delay", "delay", 0.002}, [](Arm& a, double v) { a.late = v; }},
    {{"sensor_drift", "rate", 0.0006}, [](Arm& a, double v) { a.drift = v; }},
    {{"long upper link", "", 0.03}, [](Arm& a, double v) { a.l1 *= 1 + v; }},
    {{"long lower link", "", 0.03}, [](Arm& a, double v) { a.l2 *= 1 + v; }},
    {{"cogging", "", 0.02}, [](Arm& a, double v) { a.cogging = v; }},
    {{"drag", "", 0.02}, [](Arm& a, double v) { a.drag = v; }},
    {{"coupling", "", 0.05}, [](Arm& a, double v) { a.coupling = v; }},
    {{"crosstalk", "", 0.02}, [](Arm& a, double v) { a.crosstalk = v; }},
    {{"wander", "", 0.02}, [](Arm& a, double v) { a.wander = v; }},
    {{"one-sided spring", "", 0.05}, [](Arm& a, double v) { a.one_sided = v; }},
};

}  // namespace

Robot ArmRobot() {
  Robot robot{
      "arm",  kModel, kExperiment, {"u1", "u2"}, {"q1", "q2", "x", "z"}, {1e-3, 1e-3, 3e-4, 3e-4},
      kPeriod};
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    Columns u;
    for (const double high : {1.0, 0.5})
      u.push_back(StepsAndSines(trial, high, rows, kPeriod, rng));
    return u;
  };
  Equip(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
