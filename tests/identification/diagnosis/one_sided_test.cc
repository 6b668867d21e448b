// ctest labels: slow
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/diagnosis_files.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A mass on a spring that two cylinders push to and fro, each only from a dead pressure on:
//
//   m x'' = max(0, u − p) − max(0, −u − p) − b x' − k x
//
// The model has no dead pressure. More pressure in both does nothing, less in both is p.
class OneSided : public testing::Bench {
 protected:
  static constexpr double kMass = 0.5, kStiffness = 40, kDamping = 2, kDead = 0.3;

  static std::vector<double> Run(const std::vector<double>& u) {
    constexpr double h = 1e-4;
    double x = 0, v = 0;
    std::vector<double> out;
    for (const double input : u) {
      out.push_back(x);
      const double push = std::copysign(std::max(0.0, std::abs(input) - kDead), input);
      for (int k = 0; k < std::lround(testing::kPeriod / h); ++k) {
        v += h * (push - kDamping * v - kStiffness * x) / kMass;
        x += h * v;
      }
    }
    return out;
  }

  void AddTrial(int trial, const std::string& use) {
    const auto u = testing::Command(trial, 200);
    const auto x = Run(u);
    for (unsigned replicate = 0; replicate < 2; ++replicate) {
      const auto y = testing::Noisy(x, 1e-4, 0, static_cast<unsigned>(10 * trial) + replicate);
      std::string csv = "t,push,pull,x\n";
      for (std::size_t k = 0; k < u.size(); ++k) {
        csv += fmt::format("{},{},{},{}\n", testing::kPeriod * static_cast<double>(k),
                           std::max(0.0, u[k]), std::max(0.0, -u[k]), y[k]);
      }
      const std::string file = fmt::format("t{}_{}.csv", trial, replicate);
      Write(file, csv);
      logs_ += fmt::format("  - {{file: {}, trial: t{}, use: {}}}\n", file, trial, use);
    }
  }

  std::string Xml() const {
    return fmt::format(R"(<mujoco>
  <option timestep="0.001" integrator="implicitfast" gravity="0 0 0"/>
  <worldbody>
    <body>
      <joint name="x" type="slide" axis="1 0 0" stiffness="{}" damping="{}"/>
      <inertial pos="0 0 0" mass="{}" diaginertia="1e-3 1e-3 1e-3"/>
    </body>
  </worldbody>
  <actuator>
    <general name="push" joint="x" forcerange="0 100"/>
    <general name="pull" joint="x" gear="-1" forcerange="0 100"/>
  </actuator>
  <sensor><jointpos name="x" joint="x"/></sensor>
</mujoco>
)",
                       kStiffness, kDamping, kMass);
  }
};

TEST_F(OneSided, ADeadPressureIsAnOffsetOfTheInputs) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  for (int t = 0; t < 4; ++t) AddTrial(t, t < 3 ? "train" : "validate");
  const Experiment e = Experiment::Read(Write(
      "experiment.yaml",
      "format: 1\nmodel: model.xml\nstart: rest\ntime: {column: t, unit: s}\nlogs:\n" + logs_ +
          "inputs:\n  - {column: push, unit: N, actuator: push}\n"
          "  - {column: pull, unit: N, actuator: pull}\n"
          "outputs:\n  - {column: x, unit: m, sensor: x}\n"
          "parameters:\n  - {name: k, target: 'joint:x', attribute: stiffness, lower: 10, upper: "
          "100}\ncandidates: [{effect: input_offset, where: 'actuator:*'}, input_gain]\n"));
  const Diagnosis d = Diagnose(e, ModelSpec::Load(Write("model.xml", Xml())), {});
  ASSERT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "input_offset");
  EXPECT_NEAR(d.chosen()->fitted.fit.x[d.chosen()->first_extra()], -kDead, 0.02 * kDead);
  testing::WriteFiles(e, d, folder_ / "out");
  const std::string page = ReadFile(folder_ / "out" / "report.html");
  EXPECT_THAT(page, HasSubstr("missing force [N]"));
  EXPECT_THAT(page, Not(HasSubstr("[rad")));
}

}  // namespace
}  // namespace continuum
