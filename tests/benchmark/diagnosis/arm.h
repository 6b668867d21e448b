#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "identification/problem/problem.h"
#include "identification/statistics/noise_model.h"
#include "sim/experiment/experiment.h"
#include "sim/io/file.h"

namespace continuum::speed {

/// Three links in a vertical plane, so six states, with a motor at each joint; {} is what its tip
/// carries [kg].
inline constexpr const char* kArm = R"(<mujoco model="three-link arm">
  <option timestep="0.002" integrator="implicitfast"/>
  <worldbody>
    <body name="upper">
      <joint name="q1" axis="0 -1 0" stiffness="2" damping="0.05"/>
      <inertial pos="0 0 -0.15" mass="0.5" diaginertia="0.004 0.004 0.0001"/>
      <body name="lower" pos="0 0 -0.3">
        <joint name="q2" axis="0 -1 0" stiffness="2" damping="0.05"/>
        <inertial pos="0 0 -0.125" mass="0.3" diaginertia="0.0016 0.0016 0.0001"/>
        <body name="hand" pos="0 0 -0.25">
          <joint name="q3" axis="0 -1 0" stiffness="2" damping="0.05"/>
          <inertial pos="0 0 -0.1" mass="0.2" diaginertia="0.0007 0.0007 0.0001"/>
          <body name="tip" pos="0 0 -0.2">
            <inertial pos="0 0 0" mass="{}" diaginertia="1e-9 1e-9 1e-9"/>
            <site name="tip"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="u1" joint="q1"/>
    <motor name="u2" joint="q2"/>
    <motor name="u3" joint="q3"/>
  </actuator>
  <sensor>
    <jointpos name="q1" joint="q1"/>
    <jointpos name="q2" joint="q2"/>
    <jointpos name="q3" joint="q3"/>
    <framepos name="tip" objtype="site" objname="tip"/>
  </sensor>
</mujoco>
)";

inline constexpr const char* kExperiment = R"(format: 1
model: arm.xml
start: rest
logs:
  - {file: 0_0.csv, trial: steps, use: train}
  - {file: 0_1.csv, trial: steps, use: train}
  - {file: 1_0.csv, trial: waves, use: train}
  - {file: 1_1.csv, trial: waves, use: train}
  - {file: 2_0.csv, trial: both, use: validate}
  - {file: 2_1.csv, trial: both, use: validate}
inputs:
  - {column: u1, unit: N*m, actuator: u1}
  - {column: u2, unit: N*m, actuator: u2}
  - {column: u3, unit: N*m, actuator: u3}
outputs:
  - {column: q1, unit: rad, sensor: q1, sigma: 1e-3}
  - {column: q2, unit: rad, sensor: q2, sigma: 1e-3}
  - {column: q3, unit: rad, sensor: q3, sigma: 1e-3}
  - {column: x, unit: m, sensor: "tip[0]", sigma: 3e-4}
  - {column: z, unit: m, sensor: "tip[2]", sigma: 3e-4}
parameters:
  - {name: stiffness, target: "joint:*", attribute: stiffness, initial: 1.9, lower: 0.2, upper: 20}
  - {name: damping, target: "joint:*", attribute: damping, initial: 0.06, lower: 0, upper: 1}
candidates: all
)";

/// Torques [N m] of 4 s at 100 Hz: steps of random height with slow sines on them.
inline std::string Commands(int trial) {
  constexpr int kRows = 400, kEach = 80;
  std::mt19937_64 rng(static_cast<std::uint64_t>(trial) + 1);
  std::uniform_real_distribution<double> height(-1, 1);
  std::array<double, 3> step{};
  std::string csv = "time,u1,u2,u3,q1,q2,q3,x,z\n";
  for (int k = 0; k < kRows; ++k) {
    const double t = 0.01 * k;
    csv += fmt::format("{:.2f}", t);
    for (int j = 0; j < 3; ++j) {
      if (k % kEach == kEach / 4) step[j] = height(rng) / (1 << j);
      csv += fmt::format(",{:.6f}", step[j] + 0.3 / (1 << j) * trial * std::sin((2 + j) * t));
    }
    csv += ",0,0,0,0,0\n";
  }
  return csv;
}

/// Six logs of the arm with a payload that its model has not, by MuJoCo at a tenth of the step,
/// with white noise.
inline Experiment ArmWithPayload(const std::filesystem::path& folder, double payload) {
  MakeFolder(folder);
  WriteFile(folder / "arm.xml", fmt::format(kArm, 1e-6));
  WriteFile(folder / "experiment.yaml", kExperiment);
  for (int trial = 0; trial < 3; ++trial) {
    for (int replicate = 0; replicate < 2; ++replicate)
      WriteFile(folder / fmt::format("{}_{}.csv", trial, replicate), Commands(trial));
  }
  Experiment e = Experiment::Read(folder / "experiment.yaml");
  WriteFile(folder / "truth.xml", fmt::format(kArm, 1e-6 + payload));
  Problem truth(e, ModelSpec::Load(folder / "truth.xml"));
  truth.StepBy(2e-4);
  std::mt19937_64 rng(1);
  std::normal_distribution<double> normal;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Trace trace = truth.Predict(Eigen::Vector2d(2, 0.05), l);
    for (std::size_t c = 0; c < trace.channel.size(); ++c) {
      for (std::size_t k = 0; k < trace.channel[c].size(); ++k)
        e.logs[l].measured[c][k] = trace.channel[c][k] + (c < 3 ? 1e-3 : 3e-4) * normal(rng);
    }
  }
  return e;
}

}  // namespace continuum::speed
