#include <algorithm>

#include <fmt/format.h>

#include "hidden_effects/outside/link_chain.h"
#include "hidden_effects/outside/signals.h"
#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

constexpr int kJoints = 5, kCables = 2;
constexpr double kLength = 0.06, kMass = 0.06, kInertia = 3e-5;  // of a link: m, kg, kg m²
constexpr double kEdge = 0.012, kLead = 0.05, kOffset = 0.02;    // m, of the sites
constexpr double kStiffness = 0.6, kDamping = 0.012;             // N m/rad, N m s/rad
constexpr double kWinch = 4000, kHardest = 60;                   // N/m, N
constexpr double kCableGive = 5e-5;                              // m

/// Where a cable passes one joint: from a site kEdge before it to one kEdge behind it.
struct Crossing {
  double length, slope, turn_before, turn_behind;  ///< m, m/rad, rad, rad

  /// side: ±kOffset.
  Crossing(double q, double side, double longer) {
    const double edge = kEdge * longer, offset = side * longer;
    const double x = edge * std::cos(q) - offset * std::sin(q) + edge;
    const double z = edge * std::sin(q) + offset * std::cos(q) - offset;
    length = std::hypot(x, z);
    const double dx = -edge * std::sin(q) - offset * std::cos(q);
    const double dz = edge * std::cos(q) - offset * std::sin(q);
    slope = (x * dx + z * dz) / length;
    turn_before = std::abs(std::atan2(z, x));
    turn_behind = std::abs(q - std::atan2(z, x));
  }
};

/// Five links that hang in a plane and two cables that bend them to either side. Cables rub at
/// their sites by Euler's law, after they have given by 50 um. Angles against the link before
/// [rad]; tensions [N], or how much of the cables is wound up [m].
struct Snake : Outside {
  using Five = Joints<kJoints>::Vector;
  double payload = 0, armature = 0, mu = 0, cubic = 0;  // kg, kg m², 1, N m/rad³
  double stretch = 0, slack = 0;                        // m/N, m
  std::array<DryFriction, kJoints> friction = {};
  bool winches = false;

  Columns Run(const Columns& u, int) const {
    Machine machine(*this);
    return Record(signals, machine, u);
  }

 protected:
  struct Machine {
    explicit Machine(const Snake& snake) : p(snake) {
      const double l = p.longer, m = p.heavier;
      chain.l.setConstant(kLength * l), chain.c.setConstant(kLength / 2 * l);
      chain.m.setConstant(kMass * m), chain.I.setConstant(kInertia * m * l * l);
      chain.armature.setConstant(p.armature);
      chain.payload = p.payload;
      chain.Prepare();
      joints.law = p.law, joints.friction = p.friction;
    }

    void Step(const std::vector<double>& u, double h) {
      joints.q += h / 2 * joints.v;
      Five torque =
          chain.Gravity(joints.q) + chain.Centrifugal(joints.q, joints.v) - kStiffness * joints.q;
      torque -= p.cubic * joints.q.array().cube().matrix();
      for (int c = 0; c < kCables; ++c) Pull(c, u[c], h, torque);
      joints.Push(chain.Inertia(joints.q), torque, Five::Constant(kDamping), Five::Zero(), h);
      joints.q += h / 2 * joints.v;
    }

    std::vector<double> Outputs() const {
      const Eigen::Vector2d tip = chain.Tip(joints.q);
      std::vector<double> y(joints.q.data(), joints.q.data() + kJoints);
      y.push_back(tip[1]), y.push_back(-tip[0]);
      return y;
    }

    // Adds what one cable does to the joints, and moves its contacts by a step.
    void Pull(int cable, double u, double h, Five& torque) {
      const double side = cable == 0 ? kOffset : -kOffset;
      double route = 0, rate = 0, rest = 0;
      std::vector<Crossing> at;
      for (int j = 0; j < kJoints; ++j) {
        at.emplace_back(joints.q[j], side, p.longer);
        route += at[j].length, rate += at[j].slope * joints.v[j];
        rest += 2 * kEdge * p.longer;
      }
      double T = p.winches ? Winch(u, route - rest) : std::max(0.0, u);
      for (int j = 0; j < kJoints; ++j) {
        T *= Contact(cable, 2 * j, at[j].turn_before, -rate, h);
        torque[j] -= T * at[j].slope;
        rate -= at[j].slope * joints.v[j];
        T *= Contact(cable, 2 * j + 1, at[j].turn_behind, -rate, h);
      }
    }

    // Tension of a cable of which u is wound up and that is longer by so much than at rest.
    double Winch(double u, double longer) const {
      const double tight = std::max(0.0, kWinch * (u + longer - p.slack));
      return std::min(tight / (1 + kWinch * p.stretch), kHardest);
    }

    // Factor on the tension behind a contact past which the cable slides toward its drive.
    double Contact(int cable, int i, double turn, double speed, double h) {
      double& give = gives[cable][i];
      give = std::clamp(give + h * speed, -kCableGive, kCableGive);
      return std::exp(-p.mu * turn * give / kCableGive);
    }

    const Snake& p;
    LinkChain<kJoints> chain;
    Joints<kJoints> joints;
    std::array<std::array<double, 2 * kJoints>, kCables> gives = {};
  };
};

struct WinchSnake : Snake {
  WinchSnake() { winches = true; }
};

std::string Sites(const std::string& of, double first, double second) {
  std::string text;
  for (int c = 1; c <= kCables; ++c) {
    const double side = c == 1 ? kOffset : -kOffset;
    text += fmt::format(
        "<site name=\"{0}{1}a\" pos=\"{2} 0 {4}\"/><site name=\"{0}{1}b\" pos=\"{3} 0 {4}\"/>\n",
        of, c, first, second, side);
  }
  return text;
}

std::string Model(bool winches) {
  std::string bodies, ends, tendons, sensors, drives;
  for (int i = 1; i <= kJoints; ++i) {
    bodies += fmt::format(
        "<body name=\"link{0}\" pos=\"{1} 0 0\"><joint name=\"bend{0}\" axis=\"0 -1 0\" "
        "stiffness=\"{2}\" damping=\"{3}\"/><inertial pos=\"{4} 0 0\" mass=\"{5}\" "
        "diaginertia=\"1e-5 {6} {6}\"/>\n",
        i, i == 1 ? 0 : kLength, kStiffness, kDamping, kLength / 2, kMass, kInertia);
    bodies += Sites(fmt::format("s{}_", i), kEdge, kLength - kEdge);
    sensors += fmt::format("<jointpos name=\"bend{0}\" joint=\"bend{0}\"/>\n", i);
    ends += "</body>";
  }
  for (int c = 1; c <= kCables; ++c) {
    tendons += fmt::format("<spatial name=\"cable{}\">", c);
    for (int i = 0; i <= kJoints; ++i)
      tendons += fmt::format("<site site=\"s{0}_{1}a\"/><site site=\"s{0}_{1}b\"/>", i, c);
    tendons += "</spatial>\n";
    // A position servo holds its tendon's length: u is wound up when that is shorter by u.
    const double length = kLead - kEdge + 2 * kEdge * kJoints + kJoints * (kLength - 2 * kEdge);
    drives += winches ? fmt::format(
                            "<general name=\"cable{0}\" tendon=\"cable{0}\" gear=\"-1\" "
                            "gainprm=\"{1}\" biastype=\"affine\" biasprm=\"{2} -{1}\" "
                            "forcerange=\"0 {3}\"/>\n",
                            c, kWinch, -kWinch * length, kHardest)
                      : fmt::format(
                            "<motor name=\"cable{0}\" tendon=\"cable{0}\" gear=\"-1\" "
                            "ctrlrange=\"0 60\"/>\n",
                            c);
  }
  return "<mujoco model=\"snake\">\n<compiler angle=\"radian\"/>\n"
         "<option timestep=\"0.002\" integrator=\"implicitfast\"/>\n<worldbody>\n"
         "<body name=\"base\" quat=\"0.7071067811865476 0 0.7071067811865476 0\">\n" +
         Sites("s0_", -kLead, -kEdge) + bodies +
         fmt::format(
             "<body name=\"tip\" pos=\"{} 0 0\"><inertial pos=\"0 0 0\" mass=\"1e-6\" "
             "diaginertia=\"1e-9 1e-9 1e-9\"/><site name=\"tip\"/></body>\n",
             kLength) +
         ends + "</body>\n</worldbody>\n<tendon>\n" + tendons + "</tendon>\n<actuator>\n" + drives +
         "</actuator>\n<sensor>\n" + sensors +
         "<framepos name=\"tip\" objtype=\"site\" objname=\"tip\"/>\n</sensor>\n</mujoco>\n";
}

std::string ExperimentText(bool winches) {
  std::string text = "inputs:\n";
  for (int c = 1; c <= kCables; ++c)
    text += fmt::format("  - {{column: u{0}, unit: {1}, actuator: cable{0}}}\n", c,
                        winches ? "m" : "N");
  text += "outputs:\n";
  for (int i = 1; i <= kJoints; ++i)
    text += fmt::format("  - {{column: bend{0}, unit: rad, sensor: bend{0}}}\n", i);
  return text + R"(  - {column: x, unit: m, sensor: "tip[0]"}
  - {column: z, unit: m, sensor: "tip[2]"}
parameters:
  - {name: stiffness, target: "joint:bend*", attribute: stiffness, initial: 0.55, lower: 0.1, upper: 3}
  - {name: damping, target: "joint:bend*", attribute: damping, initial: 0.015, lower: 0, upper: 0.3}
)";
}

template <class Plant>
std::vector<Part<Plant>> Parts() {
  return {
      {{"payload", "mass", 0.03}, [](Plant& p, double v) { p.payload = v; }},
      {{"armature", "armature", 5e-5}, [](Plant& p, double v) { p.armature = v; }},
      {{"coulomb", "tau_c", 0.02},
       [](Plant& p, double v) {
         for (auto& f : p.friction) f.tau_c = v;
       }},
      {{"stribeck", "tau_c", 0.02},
       [](Plant& p, double v) {
         for (auto& f : p.friction) f.tau_c = v, f.S = 0.8;
       }},
      {{"capstan", "mu", 0.15}, [](Plant& p, double v) { p.mu = v; }},
      {{"cubic_stiffness", "k3", 0.8}, [](Plant& p, double v) { p.cubic = v; }},
      {{"tendon_stretch", "compliance", 2e-4}, [](Plant& p, double v) { p.stretch = v; }},
      {{"slack", "length", 3e-3}, [](Plant& p, double v) { p.slack = v; }},
      {{"input_gain", "gain", 0.05, 1}, [](Plant& p, double v) { p.signals.gain = 1 + v; }},
      {{"dead_time", "delay", 0.015, 0, {"sensor_delay"}},
       [](Plant& p, double v) { p.signals.dead_time = v; }},
      {{"pt1", "T", 0.02}, [](Plant& p, double v) { p.signals.lag = v; }},
  };
}

Robot Make(const std::string& name, bool winches) {
  Robot robot{name, Model(winches), ExperimentText(winches), {"u1", "u2"}, {}, {}, kRowPeriod};
  for (int i = 1; i <= kJoints; ++i) robot.outputs.push_back("bend" + std::to_string(i));
  robot.sigma.assign(kJoints, 2e-3);
  for (const char* const axis : {"x", "z"})
    robot.outputs.push_back(axis), robot.sigma.push_back(5e-4);
  robot.trials = 5, robot.held_out = 2;
  robot.drive = [winches, rows = robot.rows](int trial, std::mt19937_64& rng) {
    const double rest = winches ? 1.5e-3 : 5, high = winches ? 0.018 : 14;
    const std::vector<double> bend = StepsAndSines(trial % 3, high, rows, kRowPeriod, rng);
    Columns u(kCables);
    for (const double b : bend) {
      u[0].push_back(winches ? rest + b : rest + std::max(0.0, b));
      u[1].push_back(winches ? rest - b : rest + std::max(0.0, -b));
    }
    return u;
  };
  return robot;
}

}  // namespace

Robot SnakeRobot() {
  Robot robot = Make("snake", false);
  EquipOutside(robot, Parts<Snake>());
  return robot;
}

Robot WinchSnakeRobot() {
  Robot robot = Make("winch_snake", true);
  EquipOutside(robot, Parts<WinchSnake>());
  return robot;
}

}  // namespace continuum::hidden
