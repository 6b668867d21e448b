// ctest labels: slow
// A hidden supply that sags is found, with its resistance.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

// Two wheels on springs, each with a motor, on one battery, by an integrator of their own:
//
//   J q'' = u_i V/V_0 − b q' − k q,   V = V_0 − R_s Σ |torque|/k_t
constexpr double kInertia = 0.02, kDamping = 0.05, kSpring = 1.5;
constexpr double kVoltage = 12, kResistance = 0.9, kMotor = 0.5;  // V, Ohm, N m/A
constexpr double kR = kResistance / (kMotor * kVoltage);          // 1/(N m)
constexpr std::size_t kRows = 300;

using Columns = std::vector<std::vector<double>>;

// Steps and sines; the second motor rests in half of each trial.
Columns Commands(int trial) {
  Columns u{testing::Command(trial, kRows), testing::Command(trial + 1, kRows)};
  for (std::size_t k = 0; k < kRows; ++k) {
    u[0][k] *= 1.5;
    u[1][k] = k < kRows / 2 ? 0 : 2 * u[1][k] + (trial % 2 ? 0.8 : -0.8);
  }
  return u;
}

// The voltage by iteration of Ohm's law, whose contraction is kR Σ |u| < 1 here.
double VoltageAt(double u1, double u2) {
  double V = kVoltage;
  for (int n = 0; n < 200; ++n) {
    const double current = (std::abs(u1) + std::abs(u2)) * V / kVoltage / kMotor;
    V = 0.5 * V + 0.5 * (kVoltage - kResistance * current);
  }
  return V;
}

Columns Turned(const Columns& u) {
  constexpr int kSteps = 200;
  constexpr double h = testing::kPeriod / kSteps;
  double q[2] = {0, 0}, v[2] = {0, 0};
  Columns angle(2);
  for (std::size_t row = 0; row < kRows; ++row) {
    const double part = VoltageAt(u[0][row], u[1][row]) / kVoltage;
    for (int i = 0; i < 2; ++i) {
      angle[i].push_back(q[i]);
      for (int k = 0; k < kSteps; ++k) {
        v[i] += h * (u[i][row] * part - kDamping * v[i] - kSpring * q[i]) / kInertia;
        q[i] += h * v[i];
      }
    }
  }
  return angle;
}

class HiddenSupply : public testing::Bench {
 protected:
  static std::string Xml() {
    std::string bodies, actuators, sensors;
    for (const char* const name : {"left", "right"}) {
      bodies += fmt::format(
          "<body name='{0}'><joint name='{0}' axis='0 1 0' damping='{1}' "
          "stiffness='{2}'/><inertial "
          "pos='0 0 0' mass='1' diaginertia='1 {3} 1'/></body>",
          name, kDamping, kSpring, kInertia);
      actuators += fmt::format("<motor name='{0}' joint='{0}'/>", name);
      sensors += fmt::format("<jointpos name='{0}' joint='{0}'/>", name);
    }
    return "<mujoco><option timestep='0.002' integrator='implicitfast' gravity='0 0 "
           "0'/><worldbody>" +
           bodies + "</worldbody><actuator>" + actuators + "</actuator><sensor>" + sensors +
           "</sensor></mujoco>";
  }

  void AddTrial(int trial, unsigned copy) {
    const Columns u = Commands(trial);
    Columns q = Turned(u);
    for (unsigned i = 0; i < 2; ++i)
      q[i] = testing::Noisy(q[i], 1e-3, 0, 100 * static_cast<unsigned>(trial) + 10 * copy + i);
    std::string csv = "time,u1,u2,q1,q2\n";
    for (std::size_t k = 0; k < kRows; ++k) {
      csv += fmt::format("{},{},{},{},{}\n", testing::kPeriod * static_cast<double>(k), u[0][k],
                         u[1][k], q[0][k], q[1][k]);
    }
    const std::string file = fmt::format("t{}_{}.csv", trial, copy);
    Write(file, csv);
    logs_ += fmt::format("  - {{file: {}, trial: t{}, use: {}}}\n", file, trial,
                         trial == 2 ? "validate" : "train");
  }

  Experiment Read(const std::string& candidates) {
    return Experiment::Read(Write(
        "experiment.yaml",
        "format: 1\nmodel: model.xml\nstart: rest\nlogs:\n" + logs_ +
            "inputs:\n  - {column: u1, unit: N*m, actuator: left}\n"
            "  - {column: u2, unit: N*m, actuator: right}\n"
            "outputs:\n  - {column: q1, unit: rad, sensor: left}\n"
            "  - {column: q2, unit: rad, sensor: right}\n"
            "parameters:\n  - {name: b, target: 'joint:*', attribute: damping, initial: 0.05, "
            "lower: 0, upper: 1}\ncandidates: " +
            candidates + "\n"));
  }
};

TEST_F(HiddenSupply, IsNamedWithItsResistance) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  for (int trial = 0; trial < 3; ++trial) {
    for (unsigned copy = 0; copy < 2; ++copy) AddTrial(trial, copy);
  }
  const Experiment e =
      Read("[input_gain, torque_limit, supply_sag, coulomb, cubic_stiffness, sensor_scale]");
  DiagnosisOptions options;
  options.placebos = 0;
  const Diagnosis d = Diagnose(e, ModelSpec::Load(Write("model.xml", Xml())), options);
  ASSERT_TRUE(d.chosen()) << d.verdict.reason;
  EXPECT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.NameAtPlace(), "supply_sag at actuators left, right");
  EXPECT_NEAR(d.chosen()->fitted.fit.x[d.chosen()->first_extra()], kR, 0.05 * kR);
}

}  // namespace
}  // namespace continuum
