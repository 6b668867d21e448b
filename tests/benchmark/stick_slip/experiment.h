#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmark/stick_slip/slider.h"
#include "sim/experiment/experiment.h"
#include "sim/io/file.h"

namespace continuum::stick_slip {

inline constexpr double kPeriod = 0.01;  // s
inline constexpr std::size_t kRows = 500, kLogs = 2;
inline constexpr std::array kNames{"tau_c", "stiffness", "damping", "mass"};
inline constexpr Slider kTruth;
inline constexpr std::array kTrue{kTruth.tau_c, kTruth.stiffness, kTruth.damping, kTruth.mass};

inline constexpr const char* kModel = R"(<mujoco>
  <option timestep="{}" integrator="implicitfast"/>
  <extension><plugin plugin="continuum.coulomb"><instance name="dry">
    <config key="joint" value="slide"/><config key="tau_c" value="2"/>
  </instance></plugin></extension>
  <worldbody><body name="block">
    <joint name="slide" type="slide" axis="1 0 0" stiffness="260" damping="2.5"/>
    <inertial pos="0 0 0" mass="0.4" diaginertia="1 1 1"/>
  </body></worldbody>
  <actuator><motor name="force" joint="slide"/></actuator>
  <sensor><jointpos name="q" joint="slide"/></sensor>
</mujoco>
)";

inline constexpr const char* kExperiment = R"(format: 1
model: model.xml
logs: [{{file: steps.csv}}, {{file: waves.csv}}]
start: rest
inputs: [{{column: u, unit: N, actuator: force}}]
outputs: [{{column: q, unit: m, sensor: q, sigma: {}}}]
parameters:
  - {{name: tau_c, target: "plugin:dry", attribute: tau_c, lower: 0.6, upper: 12}}
  - {{name: stiffness, target: "joint:slide", attribute: stiffness, lower: 40, upper: 800}}
  - {{name: damping, target: "joint:slide", attribute: damping, lower: 0.8, upper: 16}}
  - {{name: mass, target: "body:block", attribute: mass, lower: 0.1, upper: 2}}
)";

/// Forces [N]: steps of random height, and in the second log slow waves between them.
inline std::vector<double> Command(std::size_t log) {
  std::mt19937_64 rng(log + 1);
  std::uniform_real_distribution<double> height(-12, 12);
  constexpr std::size_t kEach = 50;
  std::vector<double> u;
  for (std::size_t k = 0; k < kRows; ++k) {
    if (k % kEach == 0)
      u.push_back(height(rng));
    else
      u.push_back(u[k - k % kEach] + (log ? 3 * std::sin(0.06 * static_cast<double>(k)) : 0));
  }
  return u;
}

/// The experiment with logs of the slider, without noise.
inline Experiment Clean(const std::filesystem::path& folder, double step, double sigma) {
  WriteFile(folder / "model.xml", fmt::format(kModel, step));
  WriteFile(folder / "experiment.yaml", fmt::format(kExperiment, sigma));
  for (std::size_t l = 0; l < kLogs; ++l) {
    const auto u = Command(l);
    const auto motion = kTruth.Run(u, kPeriod);
    std::string csv = "time,u,q\n";
    for (std::size_t k = 0; k < kRows; ++k)
      csv += fmt::format("{:.2f},{},{}\n", kPeriod * static_cast<double>(k), u[k], motion.q[k]);
    WriteFile(folder / (l ? "waves.csv" : "steps.csv"), csv);
  }
  return Experiment::Read(folder / "experiment.yaml");
}

}  // namespace continuum::stick_slip
