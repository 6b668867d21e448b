// ctest labels: slow
// What is hidden at one of two joints that share a fitted parameter.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

// An axis on a position servo, J q'' = k_p (u − q) − b q', by symplectic Euler at 50 us.
std::vector<double> Axis(const std::vector<double>& u, double b) {
  constexpr double kInertia = 0.02, kp = 5, h = 5e-5;
  double q = 0, v = 0;
  std::vector<double> angle;
  for (const double goal : u) {
    angle.push_back(q);
    for (long k = 0; k < std::lround(testing::kPeriod / h); ++k) {
      v += h / kInertia * (kp * (goal - q) - b * v);
      q += h * v;
    }
  }
  return angle;
}

class SingleJoint : public testing::Bench {
 protected:
  void AddTrial(int trial, unsigned copy, double damping) {
    const auto u1 = testing::Command(trial, 300), u2 = testing::Command(trial + 1, 300);
    const unsigned seed = 4 * static_cast<unsigned>(trial) + 2 * copy;
    const auto q1 = testing::Noisy(Axis(u1, 0.3), 2e-4, 0, seed),
               q2 = testing::Noisy(Axis(u2, damping), 2e-4, 0, seed + 1);
    std::string csv = "time,u1,u2,q1,q2\n";
    for (std::size_t k = 0; k < u1.size(); ++k)
      csv += fmt::format("{},{},{},{},{}\n", testing::kPeriod * static_cast<double>(k), u1[k],
                         u2[k], q1[k], q2[k]);
    const std::string name = fmt::format("t{}_{}.csv", trial, copy);
    Write(name, csv);
    logs_ += fmt::format("  - {{file: {}, trial: t{}, use: {}}}\n", name, trial,
                         trial < 2 ? "train" : "validate");
  }
};

TEST_F(SingleJoint, ADampingOfOneOfTwoAxesIsNamedFirst) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  for (int trial = 0; trial < 3; ++trial)
    for (unsigned copy = 0; copy < 2; ++copy) AddTrial(trial, copy, 0.55);
  Write("model.xml", R"(<mujoco><option timestep="0.001" integrator="implicitfast"/><worldbody>
    <body><joint name="first" axis="0 0 1" damping="0.3"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body>
    <body pos="1 0 0"><joint name="second" axis="0 0 1" damping="0.3"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody>
    <actuator><position name="s1" joint="first" kp="5"/><position name="s2" joint="second" kp="5"/>
    </actuator><sensor><jointpos name="a1" joint="first"/><jointpos name="a2" joint="second"/>
    </sensor></mujoco>)");
  const Experiment e = Experiment::Read(
      Write("experiment.yaml",
            "format: 1\nmodel: model.xml\nstart: rest\nlogs:\n" + logs_ +
                "inputs:\n  - {actuator: s1, column: u1, unit: rad}\n"
                "  - {actuator: s2, column: u2, unit: rad}\n"
                "outputs:\n  - {column: q1, unit: rad, sensor: a1}\n"
                "  - {column: q2, unit: rad, sensor: a2}\n"
                "parameters:\n  - {name: b, target: 'joint:*', attribute: damping, operation: "
                "scale, initial: 1.2, lower: 0.1, upper: 5}\n"
                "  - {name: kp, target: 'actuator:*', attribute: kp, operation: scale, initial: "
                "0.9, lower: 0.3, upper: 3}\n"
                "candidates: [viscous, maxwell, coulomb, load_friction, pt1]\n"));
  const Diagnosis d = Diagnose(e, ModelSpec::Load(e.model), {});
  // A fast creep does nearly the same.
  ASSERT_TRUE(d.chosen()) << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.NameAtPlace(), "viscous at joint second") << d.verdict.reason;
  EXPECT_NEAR(d.last().fit.x.tail(1)[0], 0.25, 5e-3);
}

}  // namespace
}  // namespace continuum
