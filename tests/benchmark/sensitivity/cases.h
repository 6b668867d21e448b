#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmark/diagnosis/arm.h"
#include "sim/experiment/experiment.h"
#include "sim/io/file.h"

namespace continuum::speed {

/// An experiment with one log of 4 s at 100 Hz in which effects act. What was measured is zero:
/// only the time of a Jacobian counts.
struct SensitivityCase {
  std::string name, model, inputs, outputs, parameters, header;
  /// Inputs at a time [s], in the order of the header.
  std::function<std::vector<double>(double)> command;
  std::size_t measured;
};

inline Experiment ExperimentOf(const SensitivityCase& c, const std::filesystem::path& folder) {
  MakeFolder(folder);
  WriteFile(folder / "model.xml", c.model);
  std::string csv = c.header + "\n";
  for (int k = 0; k < 400; ++k) {
    csv += fmt::format("{:.2f}", 0.01 * k);
    for (const double u : c.command(0.01 * k)) csv += fmt::format(",{:.6f}", u);
    for (std::size_t i = 0; i < c.measured; ++i) csv += ",0";
    csv += "\n";
  }
  WriteFile(folder / "log.csv", csv);
  WriteFile(folder / "e.yaml",
            fmt::format("format: 1\nmodel: model.xml\nstart: rest\nlogs: [{{file: log.csv}}]\n"
                        "inputs:\n{}outputs:\n{}parameters:\n{}",
                        c.inputs, c.outputs, c.parameters));
  return Experiment::Read(folder / "e.yaml");
}

inline std::string WithEffects(std::string xml, const std::string& plugins) {
  return xml.insert(xml.find("<worldbody>"), "<extension>" + plugins + "</extension>\n");
}

inline std::string Parameter(const std::string& name, const std::string& target,
                             const std::string& attribute, double value) {
  return fmt::format(
      "  - {{name: {}, target: '{}', attribute: {}, initial: {}, lower: {}, upper: "
      "{}}}\n",
      name, target, attribute, value, value / 4, value * 4);
}

/// The three-link arm of the diagnosis benchmark with dry friction of its own in each joint;
/// lengths: with those of its links among the parameters.
inline SensitivityCase Arm(bool lengths) {
  std::string plugins = "<plugin plugin='continuum.coulomb'>", parameters;
  for (int j = 1; j <= 3; ++j) {
    plugins += fmt::format(
        "<instance name='f{0}'><config key='joint' value='q{0}'/><config key='tau_c' "
        "value='{1}'/></instance>",
        j, 0.06 / j);
    const std::string joint = fmt::format("joint:q{}", j);
    parameters +=
        Parameter(fmt::format("tau_c{}", j), fmt::format("plugin:f{}", j), "tau_c", 0.06 / j) +
        Parameter(fmt::format("k{}", j), joint, "stiffness", 2) +
        Parameter(fmt::format("b{}", j), joint, "damping", 0.05);
  }
  for (const auto& [body, place] : {std::pair{"lower", -0.3}, {"hand", -0.25}, {"tip", -0.2}}) {
    if (!lengths) break;
    parameters += fmt::format(
        "  - {{name: {0}, target: 'body:{0}', attribute: 'pos[2]', initial: {1}, lower: -1, upper: "
        "0}}\n",
        body, place);
  }
  return {lengths ? "the same with lengths of links" : "three-link arm, coulomb in each joint",
          WithEffects(fmt::format(kArm, 1e-6), plugins + "</plugin>"),
          "  - {column: u1, unit: N*m, actuator: u1}\n  - {column: u2, unit: N*m, actuator: u2}\n"
          "  - {column: u3, unit: N*m, actuator: u3}\n",
          "  - {column: q1, unit: rad, sensor: q1, sigma: 1}\n"
          "  - {column: q2, unit: rad, sensor: q2, sigma: 1}\n"
          "  - {column: q3, unit: rad, sensor: q3, sigma: 1}\n",
          parameters,
          "time,u1,u2,u3,q1,q2,q3",
          [](double t) {
            return std::vector{0.9 * std::sin(2 * t), 0.5 * std::sin(3 * t), 0.2 * std::sin(5 * t)};
          },
          3};
}

/// The snake arm as it stands: stribeck in ten joints, capstan on four cables of five links.
inline SensitivityCase Annelida() {
  SensitivityCase c{
      "annelida, stribeck and capstan",
      ReadFile(std::filesystem::path(CONTINUUM_SOURCE) / "models/annelida/annelida.xml"),
      "",
      "",
      Parameter("K", "joint:bend*", "stiffness", 1.2379),
      "time",
      [](double t) {
        const double pull = 20 + 15 * std::sin(3 * t), turn = 8 * std::sin(2 * t);
        return std::vector{pull, 20 + turn, 40 - pull, 20 - turn};
      },
      10};
  for (const auto& [name, value] :
       {std::pair{"tau_mu", 0.0314}, {"tau_c", 0.0413}, {"S", 0.7472}, {"v_d", 0.2994}})
    c.parameters += Parameter(name, "plugin:joint_friction", name, value);
  c.parameters += Parameter("mu", "plugin:cable_friction", "mu", 0.15);
  for (int i = 1; i <= 4; ++i) {
    c.inputs += fmt::format("  - {{column: T{0}, unit: N, actuator: cable{0}}}\n", i);
    c.header += fmt::format(",T{}", i);
  }
  for (int i = 1; i <= 5; ++i) {
    for (const char axis : {'x', 'y'}) {
      c.outputs += fmt::format(
          "  - {{column: q{0}{1}, unit: rad, sensor: bend{0}_{1}, sigma: 1}}\n", i, axis);
      c.header += fmt::format(",q{}{}", i, axis);
    }
  }
  return c;
}

/// The servo with a pendulum, its gear loaded by the torque through it.
inline SensitivityCase Servo() {
  std::string xml = ReadFile(std::filesystem::path(CONTINUUM_SOURCE) /
                             "models/servo_pendulum/servo_pendulum.xml");
  const std::string effect = "continuum.coulomb", key = "<config key=\"tau_c\"";
  xml.replace(xml.find(effect), effect.size(), "continuum.load_friction");
  xml.insert(xml.find(key), "<config key=\"mu_l\" value=\"0.1\"/>");
  return {"servo pendulum, load_friction",
          xml,
          "  - {column: goal, unit: rad, actuator: servo}\n",
          "  - {column: q, unit: rad, sensor: q, sigma: 1}\n",
          Parameter("tau_c", "plugin:friction", "tau_c", 0.02) +
              Parameter("mu_l", "plugin:friction", "mu_l", 0.1) +
              Parameter("damping", "joint:q", "damping", 0.008) +
              Parameter("armature", "joint:q", "armature", 0.0017) +
              Parameter("mass", "body:pendulum", "mass", 0.49) +
              Parameter("kp", "actuator:servo", "kp", 0.2),
          "time,goal,q",
          [](double t) { return std::vector{1.5 * std::sin(2.5 * t) + 0.5 * std::sin(7 * t)}; },
          1};
}

}  // namespace continuum::speed
