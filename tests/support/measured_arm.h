#pragma once

#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>

#include "sim/experiment/experiment.h"
#include "sim/experiment/registration.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/simulate.h"
#include "support/scratch.h"

namespace continuum::testing {

/// An arm of two links that bends in two planes, its tip seen by a camera that stands elsewhere.
class MeasuredArm {
 public:
  static constexpr double kStiffness = 0.4;  // N m/rad, of both joints

  /// keys: further lines of the experiment's file. Two logs: train and validate.
  Experiment Read(const std::string& keys, const std::string& joints = "xy") const {
    scratch_.Write("arm.xml", Xml(joints));
    for (const std::string name : {"train", "validate"}) scratch_.Write(name + ".csv", Rows(name));
    return Experiment::Read(
        scratch_.Write("e.yaml",
                       "format: 1\nmodel: arm.xml\nlogs:\n  - {file: train.csv, use: train}\n"
                       "  - {file: validate.csv, use: validate}\ninputs:\n"
                       "  - {column: u1, actuator: a, interpolate: linear}\n"
                       "  - {column: u2, actuator: b, interpolate: linear}\noutputs:\n"
                       "  - {column: x, unit: mm, sensor: \"tip[0]\"}\n"
                       "  - {column: y, unit: mm, sensor: \"tip[1]\"}\n"
                       "  - {column: z, unit: mm, sensor: \"tip[2]\"}\n" +
                           keys));
  }
  const Scratch& folder() const { return scratch_; }

  /// What a camera measures that is registered like this, with white noise [m] on top: the model is
  /// simulated at a tenth of the rows' period and read at the times at which the camera looks.
  static void Measure(Experiment& e, const ModelSpec& system, const Registration& camera,
                      double noise = 0) {
    std::mt19937 random(7);
    std::normal_distribution<double> error(0, noise > 0 ? noise : 1);
    for (Log& log : e.logs) {
      Log dense = log;
      dense.time.clear();
      for (auto& column : dense.input) column.clear();
      for (auto& column : dense.measured) column.clear();
      const auto count = static_cast<std::size_t>(std::lround(log.time.back() / kPeriod)) * kDense;
      for (std::size_t k = 0; k <= count; ++k) {
        dense.time.push_back(static_cast<double>(k) * kPeriod / kDense);
        for (std::size_t i = 0; i < 2; ++i)
          dense.input[i].push_back(Command(log.label, i, dense.time.back()));
        for (auto& column : dense.measured) column.push_back(0);
      }
      Experiment seen = e;
      seen.registration = camera;
      seen.registration.clock_shift = 0;
      seen.quasi_static = false;
      ModelAndData machine = system.Build();
      const Trace trace = Simulate(machine, seen, dense);
      const auto late =
          static_cast<std::ptrdiff_t>(std::lround(camera.clock_shift * kDense / kPeriod));
      for (std::size_t c = 0; c < log.measured.size(); ++c) {
        for (std::size_t k = 0; k < log.rows(); ++k) {
          const auto row = static_cast<std::ptrdiff_t>(k * kDense) - late;
          log.measured[c][k] = row < 0 || row > static_cast<std::ptrdiff_t>(count)
                                   ? std::nan("")
                                   : trace.channel[c][row] + (noise > 0 ? error(random) : 0);
        }
      }
    }
  }

 private:
  static constexpr double kPeriod = 0.01;  // s
  static constexpr std::size_t kDense = 10;

  static std::string Xml(const std::string& joints) {
    return fmt::format(R"(<mujoco><option timestep="0.001" integrator="implicitfast"/>
      <worldbody><body>
        <joint name="one" axis="0 1 0" stiffness="{0}" damping="0.02"/>
        <geom type="capsule" size=".01" fromto="0 0 0 0 0 -.2" mass=".2"/>
        <body pos="0 0 -.2">
          <joint name="two" axis="{1}" stiffness="{0}" damping="0.02"/>
          <geom type="capsule" size=".01" fromto="0 0 0 0 0 -.2" mass=".1"/>
          <site name="tip" pos="0 0 -.2"/>
        </body></body></worldbody>
      <actuator><motor name="a" joint="one"/><motor name="b" joint="two"/></actuator>
      <sensor><framepos name="tip" objtype="site" objname="tip"/></sensor></mujoco>)",
                       kStiffness, joints == "xy" ? "1 0 0" : "0 1 0");
  }
  static double Command(const std::string& log, std::size_t input, double t) {
    const double f = log == "train" ? 1 : 1.3;
    return input == 0 ? 0.35 * std::sin(2.3 * f * t) + 0.1 * std::sin(7 * f * t)
                      : 0.25 * std::sin(3.1 * f * t + 0.4) - 0.25 * std::sin(0.4);
  }
  static std::string Rows(const std::string& log) {
    std::string text = "time,u1,u2,x,y,z\n";
    for (int k = 0; k <= 500; ++k) {
      const double t = k * kPeriod;
      text += fmt::format("{},{:.9f},{:.9f},0,0,0\n", t, Command(log, 0, t), Command(log, 1, t));
    }
    return text;
  }

  Scratch scratch_;
};

}  // namespace continuum::testing
