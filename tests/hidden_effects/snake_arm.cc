#include <algorithm>
#include <cmath>

#include "hidden_effects/robots.h"
#include "models/annelida/planar_chain.h"
#include "sim/model/mjcf_document.h"

namespace continuum::hidden {
namespace {

constexpr double kPeriod = 0.01;  // s

// The arm of the model, but without dry friction of joints and cables.
AnnelidaParameters Smooth() {
  static const AnnelidaParameters arm =
      ReadAnnelida(CONTINUUM_SOURCE "/models/annelida/annelida.yaml");
  AnnelidaParameters smooth = arm;
  smooth.tau_c = smooth.S = smooth.mu = 0;
  return smooth;
}

/// The five links in a plane that are written out in models/annelida, at 20 us, pulled by cables 1
/// and 3; friction of joints and cables by bristles.
struct SnakeArm {
  AnnelidaParameters p = Smooth();
  double payload = 0, gain = 1, tilt = 0;  // kg, 1, rad

  Columns Run(const Columns& u, int) const {
    constexpr int kSteps = 500;
    const PlanarChain chain(p, payload, tilt);
    PlanarState state;
    Columns out(kAnnelidaLinks + 2);
    for (std::size_t row = 0; row < u[0].size(); ++row) {
      const Eigen::Vector2d tip = chain.Tip(state.q);
      for (int i = 0; i < kAnnelidaLinks; ++i) out[i].push_back(state.q[i]);
      for (int i = 0; i < 2; ++i) out[kAnnelidaLinks + i].push_back(tip[i]);
      for (int s = 0; s < kSteps; ++s)
        chain.Step(state, {gain * u[0][row], gain * u[2][row]}, kPeriod / kSteps);
    }
    return out;
  }
};

void Replace(std::string& text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
}

// The generated MJCF without its frictions, the viscous one of the joints as native damping.
std::string Model() {
  const AnnelidaParameters p = Smooth();
  MjcfDocument document(AnnelidaMjcf(p));
  for (const char* const instance : {"joint_friction", "cable_friction"})
    document.RemoveInstance(instance);
  std::string text = document.Text();
  Replace(text, "<default>", "<default><joint damping=\"" + std::to_string(p.tau_mu) + "\"/>");
  return text;
}

std::string ExperimentText() {
  std::string text = "inputs:\n";
  for (int i = 1; i <= 4; ++i) {
    const std::string name = "cable" + std::to_string(i);
    text += "  - {column: " + name + ", unit: N, actuator: " + name + "}\n";
  }
  text += "outputs:\n";
  for (int i = 1; i <= kAnnelidaLinks; ++i) {
    const std::string name = "bend" + std::to_string(i) + "_y";
    text += "  - {column: " + name + ", unit: rad, sensor: " + name + ", sigma: 0.003}\n";
  }
  return text + R"(  - {column: tip_x, unit: m, sensor: "tip_pos[0]", sigma: 0.0005}
  - {column: tip_z, unit: m, sensor: "tip_pos[2]", sigma: 0.0005}
parameters:
  - {name: stiffness, target: "joint:bend*", attribute: stiffness, initial: 1.2, lower: 0.6, upper: 2.4}
  - {name: damping, target: "joint:bend*", attribute: damping, initial: 0.035, lower: 0, upper: 0.3}
)";
}

const std::vector<Part<SnakeArm>> kParts{
    {{"payload", "mass", 0.02}, [](SnakeArm& a, double v) { a.payload = v; }},
    {{"stribeck", "tau_c", 0.01}, [](SnakeArm& a, double v) { a.p.tau_c = v, a.p.S = 0.7472; }},
    {{"coulomb", "tau_c", 0.01}, [](SnakeArm& a, double v) { a.p.tau_c = v; }},
    {{"capstan", "mu", 0.05}, [](SnakeArm& a, double v) { a.p.mu = v; }},
    {{"input_gain", "gain", 0.02, 1}, [](SnakeArm& a, double v) { a.gain = 1 + v; }},
    {{"gravity_tilt", "pitch", 0.02}, [](SnakeArm& a, double v) { a.tilt = v; }},
};

}  // namespace

Robot SnakeArmRobot() {
  Robot robot{"annelida", Model(), ExperimentText(), {"cable1", "cable2", "cable3", "cable4"},
              {},         {},      kPeriod,          300};
  for (int i = 1; i <= kAnnelidaLinks; ++i)
    robot.outputs.push_back("bend" + std::to_string(i) + "_y");
  robot.sigma.assign(kAnnelidaLinks, 3e-3);
  for (const char* name : {"tip_x", "tip_z"}) robot.outputs.push_back(name);
  robot.sigma.resize(kAnnelidaLinks + 2, 5e-4);
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    const std::vector<double> pull = StepsAndSines(trial, 9, rows, kPeriod, rng);
    Columns u(4, std::vector<double>(rows, 0));
    for (std::size_t k = 0; k < rows; ++k) u[pull[k] > 0 ? 0 : 2][k] = std::abs(pull[k]);
    return u;
  };
  Equip(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
