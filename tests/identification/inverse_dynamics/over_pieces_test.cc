#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/identify.h"
#include "identification/report/fit_report.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

// Two links that hang one on the other, θ1 and θ2 from the vertical, θ = (q1, q1 + q2):
//
//   A θ1'' + B cos(θ1 − θ2) θ2'' = −B sin(θ1 − θ2) θ2'² − (m1 c + m2 l) g sin θ1 − b1 q1' + b2 q2'
//   B cos(θ1 − θ2) θ1'' + C θ2'' =  B sin(θ1 − θ2) θ1'² − m2 c g sin θ2 − b2 q2'
//
// A = I1 + m1 c² + m2 l², B = m2 l c, C = I2 + m2 c²; by the classical Runge-Kutta method.
struct DoublePendulum {
  double m1 = 0.2, m2 = 0.15, l = 0.2, c = 0.1, I1 = 7e-4, I2 = 6e-4, b1 = 4e-4, b2 = 2e-4;
  using State = std::array<double, 4>;  // θ1, θ2 and their speeds

  State Rate(const State& y) const {
    constexpr double g = 9.81;
    const double A = I1 + m1 * c * c + m2 * l * l, B = m2 * l * c, C = I2 + m2 * c * c;
    const double s = std::sin(y[0] - y[1]), k = B * std::cos(y[0] - y[1]);
    const double bend = b2 * (y[3] - y[2]);
    const double f1 = -B * s * y[3] * y[3] - (m1 * c + m2 * l) * g * std::sin(y[0]) - b1 * y[2] +
                      bend,
                 f2 = B * s * y[2] * y[2] - m2 * c * g * std::sin(y[1]) - bend;
    const double det = A * C - k * k;
    return {y[2], y[3], (C * f1 - k * f2) / det, (A * f2 - k * f1) / det};
  }
  State After(State y, double h) const {
    const auto at = [&](const State& rate, double share) {
      State moved = y;
      for (int i = 0; i < 4; ++i) moved[i] += share * h * rate[i];
      return moved;
    };
    const State a = Rate(y), b = Rate(at(a, 0.5)), c4 = Rate(at(b, 0.5)), d = Rate(at(c4, 1));
    for (int i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c4[i] + d[i]);
    return y;
  }
};

class OverPieces : public testing::Bench {
 protected:
  void AddMotion(const std::string& name, double q1, double q2, unsigned seed) {
    testing::ArNoise noise(1e-3, 0, seed);
    DoublePendulum truth;
    DoublePendulum::State y{q1, q1 + q2, 0, 0};
    std::string csv = "t,q1,q2\n";
    for (int row = 0; row < 500; ++row) {
      csv += Decimal(0.01 * row) + "," + Decimal(y[0] + noise.Next()) + "," +
             Decimal(y[1] - y[0] + noise.Next()) + "\n";
      for (int k = 0; k < 100; ++k) y = truth.After(y, 1e-4);
    }
    Write(name + ".csv", csv);
    logs_ += "  - {file: " + name + ".csv, trial: " + name + ", use: train}\n";
  }
};

// Let go near the top: after five seconds a difference of 1 mrad has grown to whole turns.
TEST_F(OverPieces, FitsWhatNoParametersFollowAsAWhole) {
  AddMotion("a", 3.0, 0.1, 1);
  AddMotion("b", 2.8, -0.3, 2);
  AddMotion("c", 3.1, 0.2, 3);
  Write("model.xml", R"(<mujoco><option timestep="0.001" integrator="RK4"/><worldbody>
    <body name="a"><joint name="q1" axis="0 1 0" damping="0.001"/>
      <inertial pos="0 0 -0.1" mass="0.2" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="b" pos="0 0 -0.2"><joint name="q2" axis="0 1 0" damping="0.001"/>
        <inertial pos="0 0 -0.1" mass="0.15" diaginertia="8e-4 8e-4 8e-4"/></body></body>
    </worldbody><sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor>
    </mujoco>)");
  const Experiment e = Experiment::Read(Write(
      "experiment.yaml",
      "format: 1\nmodel: model.xml\nstart: measured\ntime: {column: t, unit: s}\nlogs:\n" + logs_ +
          "outputs:\n  - {column: q1, unit: rad, sensor: q1}\n"
          "  - {column: q2, unit: rad, sensor: q2}\nparameters:\n"
          "  - {name: b1, target: 'joint:q1', attribute: damping, lower: 0, upper: 0.1}\n"
          "  - {name: b2, target: 'joint:q2', attribute: damping, lower: 0, upper: 0.1}\n"
          "  - {name: I1, target: 'body:a', attribute: 'inertia[1]', lower: 1e-4, upper: 1.9e-3}\n"
          "  - {name: I2, target: 'body:b', attribute: 'inertia[1]', lower: 1e-4, upper: "
          "1.5e-3}\n"));
  const IdentifyResult found = Identify(e, ModelSpec::Load(e.model), {});
  ASSERT_TRUE(found.fit.over_pieces);
  const DoublePendulum truth;
  EXPECT_NEAR(found.fit.x[1], truth.b2, 0.3 * truth.b2);
  EXPECT_NEAR(found.fit.x[2], truth.I1, 0.1 * truth.I1);
  EXPECT_NEAR(found.fit.x[3], truth.I2, 0.05 * truth.I2);
  EXPECT_THAT(OverPiecesInWords(found), HasSubstr("these follow eighths of the logs"));
  EXPECT_EQ(OverNoiseInWords(found), "");
}

}  // namespace
}  // namespace continuum
