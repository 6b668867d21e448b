// ctest labels: slow
// What is hidden at a joint is found beside another one that moves in other units.
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

// A table on a spring, and on it a rotor out of balance that a servo of speed turns, by an
// integrator of its own. x: place of the table, φ: angle of the rotor,
//
//   (M + m) x'' − m r (φ'' sin φ + φ'² cos φ) = −k x − b x' − k₃ x³
//   (I + m r²) φ'' − m r x'' sin φ = κ (u − φ')
struct Table {
  double k3 = 0, k_m = 0, tau_m = 0.12;  // and a Maxwell element beside the spring
  static constexpr double M = 4, m = 0.5, r = 0.03, I = 0.0008, k = 900, b = 6, kappa = 0.02;

  // [x, phi] at 100 Hz
  std::array<std::vector<double>, 2> Run(const std::vector<double>& u) const {
    constexpr int kSteps = 400;
    constexpr double h = testing::kPeriod / kSteps;
    double x = 0, v = 0, phi = 0, w = 0, e = 0;
    std::array<std::vector<double>, 2> out;
    for (const double speed : u) {
      out[0].push_back(x), out[1].push_back(phi);
      for (int s = 0; s < kSteps; ++s) {
        const double a = M + m, c = -m * r * std::sin(phi), d = I + m * r * r;
        const double f = m * r * w * w * std::cos(phi) - k * x - b * v - k3 * x * x * x - k_m * e,
                     g = kappa * (speed - w), det = a * d - c * c;
        v += h * (f * d - c * g) / det, w += h * (a * g - c * f) / det;
        x += h * v, phi += h * w;
        e += h * (v - e / tau_m);
      }
    }
    return out;
  }
};

class MixedJoints : public testing::Bench {
 protected:
  Diagnosis Found(const Table& table) {
    for (int trial = 0; trial < 2; ++trial) {
      std::vector<double> u;
      for (int i = 0; i < 400; ++i)
        u.push_back((trial ? 13 : 11) + (5 - trial) * std::sin(0.01 * (1.3 + trial) * i));
      const auto moved = table.Run(u);
      for (unsigned copy = 0; copy < 2; ++copy) {
        const unsigned seed = 10 * static_cast<unsigned>(trial) + 2 * copy;
        AddLog(fmt::format("t{}_{}", trial, copy),
               fmt::format("trial: t{}, use: {}", trial, trial ? "validate" : "train"), u,
               testing::Noisy(moved[0], 2e-5, 0, seed));
      }
    }
    const Experiment e = ReadExperiment(
        "parameters:\n"
        "  - {name: k, target: 'joint:x', attribute: stiffness, initial: 900, lower: 400, upper: "
        "2000}\n"
        "  - {name: b, target: 'joint:x', attribute: damping, initial: 6, lower: 0, upper: 40}\n"
        "candidates: [cubic_stiffness, maxwell, link_mass, input_gain, viscous, stiffness, "
        "coulomb]\n");
    return Diagnose(e, ModelSpec::Load(Write("model.xml", kModel)), {});
  }

  static constexpr char kModel[] =
      R"(<mujoco><option timestep="0.001" integrator="implicitfast"/><worldbody>
      <body name="table"><joint name="x" type="slide" axis="1 0 0" stiffness="900" damping="6"/>
        <inertial pos="0 0 0" mass="4" diaginertia="1 1 1"/>
        <body name="rotor"><inertial pos="0.03 0 0" mass="0.5" diaginertia=".0008 .0008 .0008"/>
          <joint name="phi" axis="0 0 1"/></body></body></worldbody>
      <actuator><velocity name="servo" joint="phi" kv="0.02"/></actuator>
      <sensor><jointpos name="angle" joint="x"/></sensor></mujoco>)";
};

TEST_F(MixedJoints, AStifferSpringIsNamedBesideARotor) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Diagnosis d = Found({.k3 = 3e5});
  ASSERT_TRUE(d.Is(Verdict::Kind::kNamed)) << d.verdict.reason;
  EXPECT_THAT(d.chosen()->hypothesis.NameAtPlace(), HasSubstr("cubic_stiffness at joint x"));
  EXPECT_NEAR(d.last().fit.x.tail(1)[0], 3e5, 2e4);
}

TEST_F(MixedJoints, ACreepIsNamedThoughItsFitLosesItsWayFromTheNullFit) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Diagnosis d = Found({.k_m = 120});
  ASSERT_TRUE(d.Is(Verdict::Kind::kNamed)) << d.verdict.reason;
  EXPECT_THAT(d.chosen()->hypothesis.NameAtPlace(), HasSubstr("maxwell at joint x"));
}

}  // namespace
}  // namespace continuum
