#pragma once

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/experiment/experiment.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"

namespace continuum::testing {

/// A pendulum on a position servo, by hand, as the source of logs that MuJoCo had no part in:
///
///   J q'' = k_p dz(u − q) − b q' − M g l sin q − τ_f,   |τ_f| ≤ τ_c,   J = I + M l²
///
/// with M = bob + tip + payload at the distance l, and dz the free play of Backlash.
struct Pendulum {
  double bob = 0.3, tip = 0.01, length = 0.2, inertia = 1.001e-3;  // kg, kg, m, kg m²
  double kp = 5, damping = 0.1, tau_c = 0;                         // N m/rad, N m s/rad, N m
  double payload = 0, gap = 0;                                     // kg, rad

  double Play(double e) const { return std::abs(e) < gap / 2 ? 0 : e - std::copysign(gap / 2, e); }

  /// Angle [rad] at every row from rest at 0, inputs held; symplectic Euler at 20 us in which
  /// friction stops the joint exactly.
  std::vector<double> Run(const std::vector<double>& u, double period) const {
    constexpr double h = 2e-5, g = 9.81;
    const int steps = static_cast<int>(std::lround(period / h));
    const double mass = bob + tip + payload, j = inertia + mass * length * length;
    double q = 0, v = 0;
    std::vector<double> angle;
    for (const double input : u) {
      angle.push_back(q);
      for (int k = 0; k < steps; ++k) {
        const double torque = kp * Play(input - q) - damping * v - mass * g * length * std::sin(q);
        const double free = v + h * torque / j, stop = h * tau_c / j;
        v = std::abs(free) <= stop ? 0 : free - std::copysign(stop, free);
        q += h * v;
      }
    }
    return angle;
  }

  /// The same as MJCF, without payload and free play; extension: instances of effects.
  std::string Xml(const std::string& extension = "", double timestep = 1e-3) const {
    return fmt::format(R"(<mujoco>
  <option timestep="{}" integrator="implicitfast"/>
  <extension>{}</extension>
  <worldbody>
    <body name="arm">
      <joint name="hinge" axis="0 1 0" damping="{}"/>
      <inertial pos="0 0 -{}" mass="{}" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="tip" pos="0 0 -{}">
        <inertial pos="0 0 0" mass="{}" diaginertia="1e-6 1e-6 1e-6"/>
      </body>
    </body>
  </worldbody>
  <actuator><position name="servo" joint="hinge" kp="{}"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>
)",
                       timestep, extension, damping, length, bob, length, tip, kp);
  }
};

inline std::string CoulombInstance(double tau_c) {
  return fmt::format(
      "<plugin plugin=\"continuum.coulomb\"><instance name=\"dry\"><config key=\"joint\" "
      "value=\"hinge\"/><config key=\"tau_c\" value=\"{}\"/></instance></plugin>",
      tau_c);
}

constexpr double kPeriod = 0.01;  // [s] of every log

/// Commands [rad] that differ in frequency and height from trial to trial, from 0 on.
inline std::vector<double> Command(int trial, std::size_t rows) {
  const double slow[] = {1.9, 3.1, 1.3, 2.3}, fast[] = {5.3, 8.9, 7.1, 11.7};
  const double high[] = {0.9, 0.7, 1.1, 0.5};
  std::vector<double> u;
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = kPeriod * static_cast<double>(k);
    u.push_back(high[trial % 4] * std::sin(slow[trial % 4] * t) +
                0.3 * std::sin(fast[trial % 4] * t));
  }
  return u;
}

/// Stationary AR(1) noise of standard deviation sigma; rho = 0 is white.
class ArNoise {
 public:
  ArNoise(double sigma, double rho, unsigned seed)
      : rng_(seed), sigma_(sigma), rho_(rho), last_(normal_(rng_)) {}
  double Next() {
    const double now = sigma_ * last_;
    last_ = rho_ * last_ + std::sqrt(1 - rho_ * rho_) * normal_(rng_);
    return now;
  }

 private:
  std::mt19937 rng_;
  std::normal_distribution<double> normal_;
  double sigma_, rho_, last_;
};

inline std::vector<double> Noisy(std::vector<double> y, double sigma, double rho, unsigned seed) {
  ArNoise noise(sigma, rho, seed);
  for (double& value : y) value += noise.Next();
  return y;
}

/// A folder of one's own that goes with the test.
class Bench : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name =
        fmt::format("continuum_{}_{}_{}", info->test_suite_name(), info->name(), ::getpid());
    std::replace(name.begin(), name.end(), '/', '_');  // of parameterised tests
    folder_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::remove_all(folder_);
    MakeFolder(folder_);
    Write("model.xml", "<mujoco/>");  // experiments are read before their model is known
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    WriteFile(folder_ / name, text);
    return folder_ / name;
  }
  /// A log; its line in the experiment has the given keys.
  void AddLog(const std::string& name, const std::string& keys, const std::vector<double>& u,
              const std::vector<double>& q) {
    std::string csv = "time,u,q\n";
    for (std::size_t k = 0; k < u.size(); ++k) {
      csv += Decimal(kPeriod * static_cast<double>(k)) + "," + Decimal(u[k]) + "," + Decimal(q[k]) +
             "\n";
    }
    Write(name + ".csv", csv);
    logs_ += "  - {file: " + name + ".csv, " + keys + "}\n";
  }
  /// The experiment of the logs so far; more: further sections, such as "parameters:\n…".
  Experiment ReadExperiment(const std::string& more, const std::string& output = "") const {
    return Experiment::Read(
        Write("experiment.yaml", "format: 1\nmodel: model.xml\nstart: rest\nlogs:\n" + logs_ +
                                     "inputs:\n  - {actuator: servo, column: u, unit: rad}\n"
                                     "outputs:\n  - {column: q, unit: rad, sensor: angle" +
                                     output + "}\n" + more));
  }

  std::filesystem::path folder_;
  std::string logs_;
};

}  // namespace continuum::testing
