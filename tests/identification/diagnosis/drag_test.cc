// ctest labels: slow
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

// A cart on a spring whose drag grows with the square of its speed, which no candidate does:
//
//   m x'' = u − k x − b x' − c |x'| x'
//
// With this noise the fit of a candidate is worse at a step of zero than at its own.
class Drag : public testing::Bench {
 protected:
  static constexpr double kMass = 1.2, kStiffness = 60, kDamping = 1.5, kDrag = 4;

  static double Force(int trial, double t) {
    const double high[] = {22.5, 17.5, 27.5, -20}, speed[] = {1.5, 6, 3.1, 2.4};
    return high[trial] * std::sin(speed[trial] * t) * (trial == 1 ? std::min(t / 0.3, 1.0) : 1);
  }

  static std::vector<double> Run(int trial, std::size_t rows) {
    constexpr double h = 1e-5;
    const auto steps = std::lround(testing::kPeriod / h);
    double x = 0, v = 0, t = 0;
    std::vector<double> out;
    for (std::size_t row = 0; row < rows; ++row) {
      out.push_back(x);
      for (long k = 0; k < steps; ++k, t += h) {
        const double force =
            Force(trial, t) - kStiffness * x - (kDamping + kDrag * std::abs(v)) * v;
        v += h * force / kMass;
        x += h * v;
      }
    }
    return out;
  }

  void AddTrials() {
    for (int trial = 0; trial < 4; ++trial) {
      const auto x = Run(trial, 301);
      double squares = 0;
      for (const double value : x) squares += value * value;
      const double sigma = 0.025 * std::sqrt(squares / static_cast<double>(x.size()));
      for (unsigned replicate = 0; replicate < 2; ++replicate) {
        const auto y =
            testing::Noisy(x, sigma, 0, 300 + 10 * static_cast<unsigned>(trial) + replicate);
        std::string csv = "t,u,x\n";
        for (std::size_t k = 0; k < x.size(); ++k) {
          const double t = testing::kPeriod * static_cast<double>(k);
          csv += fmt::format("{},{},{}\n", t, Force(trial, t), y[k]);
        }
        const std::string file = fmt::format("t{}_{}.csv", trial, replicate);
        Write(file, csv);
        logs_ += fmt::format("  - {{file: {}, trial: t{}, use: {}}}\n", file, trial,
                             trial < 3 ? "train" : "validate");
      }
    }
  }

  Diagnosis Ask(const std::string& candidates) {
    const Experiment e = Experiment::Read(Write(
        "experiment.yaml",
        "format: 1\nmodel: model.xml\nstart: rest\ntime: {column: t, unit: s}\nlogs:\n" + logs_ +
            "inputs:\n  - {column: u, unit: N, actuator: u, interpolate: linear}\n"
            "outputs:\n  - {column: x, unit: m, sensor: x}\n"
            "parameters:\n  - {name: b, target: 'joint:x', attribute: damping, initial: 1.5, "
            "lower: 0, upper: 60}\ncandidates: " +
            candidates + "\n"));
    return Diagnose(e, ModelSpec::Load(Write("model.xml", Xml())), {});
  }

  static std::string Xml() {
    return fmt::format(R"(<mujoco>
  <option timestep="0.002" integrator="implicitfast" gravity="0 0 0"/>
  <worldbody>
    <body>
      <joint name="x" type="slide" axis="1 0 0" stiffness="{}" damping="{}"/>
      <inertial pos="0 0 0" mass="{}" diaginertia="1e-2 1e-2 1e-2"/>
    </body>
  </worldbody>
  <actuator><motor name="u" joint="x"/></actuator>
  <sensor><jointpos name="x" joint="x"/></sensor>
</mujoco>
)",
                       kStiffness, kDamping, kMass);
  }
};

TEST_F(Drag, IsUnexplainedWhateverIsAsked) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  AddTrials();
  for (const std::string candidates : {"all", "[clock_skew]"})
    EXPECT_EQ(Ask(candidates).verdict.word(), "unexplained") << candidates;
}

}  // namespace
}  // namespace continuum
