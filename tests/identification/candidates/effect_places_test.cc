#include "identification/candidates/effect_places.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

// The demo of the snake arm: ten joints, four cables, five angles and two coordinates of the tip.
class PlacesOfAnArm : public ::testing::Test {
 protected:
  std::vector<std::string> PlacesOf(const Candidate& candidate, continuum::SearchScope places,
                                    const std::vector<Change>& fitted = {}) {
    Experiment e = experiment_;
    e.candidates = {candidate};
    skipped_.clear();
    std::vector<std::string> where;
    found_ = MakeCandidates(e, {&system_, {}, fitted}, {}, skipped_, places);
    for (const Hypothesis& h : found_) where.push_back(h.where);
    return where;
  }

  Experiment experiment_ = Experiment::Read(CONTINUUM_SOURCE "/models/annelida/demo/annelida.yaml");
  ModelSpec system_ = ModelSpec::Load(experiment_.model);
  std::vector<Hypothesis> found_;
  std::vector<std::string> skipped_;
};

TEST_F(PlacesOfAnArm, AreSensorsOfAUnitTogetherAndEachAlone) {
  EXPECT_THAT(
      PlacesOf({"sensor_scale", "", false}, SearchScope::kFew),
      ElementsAre("sensors tip_x, tip_z", "sensors bend1_y, bend2_y, bend3_y, bend4_y, bend5_y",
                  "sensor bend1_y", "sensor bend2_y", "sensor bend3_y", "sensor bend4_y",
                  "sensor bend5_y", "sensor tip_x", "sensor tip_z"));
  EXPECT_THAT(PlacesOf({"sensor_delay", "", false}, SearchScope::kFew),
              Contains(StartsWith("sensors bend1_y, bend2_y, bend3_y, bend4_y, bend5_y, tip_x")));
  EXPECT_THAT(PlacesOf({"sensor_drift", "sensor:bend[12]_y", false}, SearchScope::kFew),
              ElementsAre("sensors bend1_y, bend2_y", "sensor bend1_y", "sensor bend2_y"));
}

TEST_F(PlacesOfAnArm, AreFewObjectsOneByOneAndManyOnlyTogether) {
  EXPECT_THAT(PlacesOf({"input_gain", "", false}, SearchScope::kFew),
              ElementsAre("actuators cable1, cable2, cable3, cable4", "actuator cable1",
                          "actuator cable2", "actuator cable3", "actuator cable4"));
  EXPECT_THAT(PlacesOf({"dahl", "", false}, SearchScope::kFew), SizeIs(1));
}

TEST_F(PlacesOfAnArm, LeaveOutEachOfManyAndTendons) {
  EXPECT_THAT(PlacesOf({"input_gain", "", false}, SearchScope::kOthers), IsEmpty());
  const auto where = PlacesOf({"dahl", "", false}, SearchScope::kOthers);
  EXPECT_THAT(where, SizeIs(10 + 1 + 4));
  EXPECT_THAT(where, Contains("joint bend3_x"));
  EXPECT_THAT(where, Contains("tendons cable1, cable2, cable3, cable4"));
  EXPECT_THAT(PlacesOf({"dahl", "joint:bend*", false}, SearchScope::kOthers), IsEmpty());
}

TEST_F(PlacesOfAnArm, AreSingleJointsWhereTheExperimentFitsAllOfThemTogether) {
  EXPECT_THAT(PlacesOf({"stiffness", "", false}, SearchScope::kFew), IsEmpty());
  EXPECT_THAT(skipped_, ElementsAre("stiffness: the experiment fits it already"));
  EXPECT_THAT(
      PlacesOf({"stiffness", "", false}, SearchScope::kOthers, {{"joint:bend*", "stiffness", 1.5}}),
      Contains("joint bend2_y"));
  EXPECT_EQ(found_.front().null, std::vector<double>{1.5});
  EXPECT_THAT(PlacesOf({"stiffness", "joint:bend2_y", false}, SearchScope::kFew),
              ElementsAre("joint bend2_y"));
}

// Three carts on springs of their own, each driven alike and seen by a sensor of its own:
//
//   m x_i'' = u_i − b x_i' − k_i x_i,   y_i = s_i x_i
class Carts : public testing::Bench {
 protected:
  static constexpr double kMass = 1, kStiffness = 60, kDamping = 1.5, kNoise = 2e-3;

  static double Force(int trial, int cart, double t) {
    const double speed[] = {3, 9, 5, 4};
    return 15 * std::sin(speed[trial] * t + cart) - 15 * std::sin(cart);
  }

  static std::vector<double> Run(int trial, int cart, double stiffness) {
    constexpr int kSteps = 1000;
    constexpr double h = testing::kPeriod / kSteps;
    double x = 0, v = 0;
    std::vector<double> out;
    for (int row = 0; row <= 200; ++row) {
      out.push_back(x);
      const double from = Force(trial, cart, testing::kPeriod * row);
      const double to = Force(trial, cart, testing::kPeriod * (row + 1));
      for (int k = 0; k < kSteps; ++k) {
        const double force = from + (to - from) * (k + 0.5) / kSteps;
        v += h * (force - kDamping * v - stiffness * x) / kMass;
        x += h * v;
      }
    }
    return out;
  }

  // What the second cart's spring and sensor are, in parts of the others'.
  void AddTrials(double spring, double scale) {
    for (int trial = 0; trial < 4; ++trial) {
      for (unsigned replicate = 0; replicate < 2; ++replicate) {
        std::vector<std::vector<double>> y;
        for (int cart = 0; cart < 3; ++cart) {
          auto x = Run(trial, cart, kStiffness * (cart == 1 ? spring : 1));
          for (double& value : x) value *= cart == 1 ? scale : 1;
          const unsigned seed = 100 + 20 * static_cast<unsigned>(trial) + 5 * replicate;
          y.push_back(testing::Noisy(x, kNoise, 0, seed + static_cast<unsigned>(cart)));
        }
        std::string csv = "t,u0,u1,u2,x0,x1,x2\n";
        for (std::size_t k = 0; k < y[0].size(); ++k) {
          const double t = testing::kPeriod * static_cast<double>(k);
          csv += fmt::format("{},{},{},{},{},{},{}\n", t, Force(trial, 0, t), Force(trial, 1, t),
                             Force(trial, 2, t), y[0][k], y[1][k], y[2][k]);
        }
        const std::string file = fmt::format("t{}_{}.csv", trial, replicate);
        Write(file, csv);
        logs_ += fmt::format("  - {{file: {}, trial: t{}, use: {}}}\n", file, trial,
                             trial < 3 ? "train" : "validate");
      }
    }
  }

  Diagnosis Ask(const std::string& candidates) {
    std::string bodies, motors, sensors, inputs, outputs;
    for (int i = 0; i < 3; ++i) {
      bodies += fmt::format(R"(<body pos="0 {0} 0"><joint name="x{0}" type="slide" axis="1 0 0"
        stiffness="{1}" damping="{2}"/><inertial pos="0 0 0" mass="{3}" diaginertia="1 1 1"/></body>)",
                            i, kStiffness, kDamping, kMass);
      motors += fmt::format(R"(<motor name="u{0}" joint="x{0}"/>)", i);
      sensors += fmt::format(R"(<jointpos name="x{0}" joint="x{0}"/>)", i);
      inputs += fmt::format("  - {{column: u{0}, actuator: u{0}, interpolate: linear}}\n", i);
      outputs += fmt::format("  - {{column: x{0}, unit: m, sensor: x{0}}}\n", i);
    }
    const std::string xml =
        "<mujoco><option timestep=\"0.001\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>"
        "<worldbody>" +
        bodies + "</worldbody><actuator>" + motors + "</actuator><sensor>" + sensors +
        "</sensor></mujoco>";
    const Experiment e = Experiment::Read(
        Write("experiment.yaml",
              "format: 1\nmodel: model.xml\nstart: rest\ntime: {column: t, unit: s}\nlogs:\n" +
                  logs_ + "inputs:\n" + inputs + "outputs:\n" + outputs +
                  "parameters:\n  - {name: k, target: 'joint:x*', attribute: stiffness, initial: "
                  "60, lower: 20, upper: 200}\ncandidates: " +
                  candidates + "\n"));
    return Diagnose(e, ModelSpec::Load(Write("model.xml", xml)), {});
  }
};

TEST_F(Carts, OneSpringThatIsStiffIsNamedThoughAllAreFittedTogether) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  AddTrials(1.1, 1);
  const Diagnosis d = Ask("[stiffness, payload, coulomb, input_gain]");
  ASSERT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.NameAtPlace(), "stiffness at joint x1");
  EXPECT_NEAR(d.chosen()->fitted.fit.x[d.chosen()->first_extra()], 66, 0.5);
}

TEST_F(Carts, OneSensorThatReadsTooMuchIsNamed) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  AddTrials(1, 1.1);
  const Diagnosis d = Ask("[sensor_scale, sensor_bias, payload, input_offset]");
  ASSERT_THAT(d.verdict.word(), AnyOf("named", "ambiguous")) << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.NameAtPlace(), "sensor_scale at sensor x1");
  EXPECT_NEAR(d.chosen()->fitted.fit.x[d.chosen()->first_extra()], 1.1, 0.005);
}

}  // namespace
}  // namespace continuum
