#include "identification/identify.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/report/fit_report.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Noisy;
using testing::Pendulum;
using ::testing::SizeIs;

const std::string kDamping =
    "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.05, lower: "
    "0, upper: 1}\n";

class IdentifyTest : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    for (const bool train : {true, false}) {
      const auto u = Command(train ? 0 : 1, 100);
      AddLog(train ? "a" : "b", train ? "use: train" : "use: validate", u,
             Noisy(Pendulum().Run(u, testing::kPeriod), 1e-3, 0, 1));
    }
    Write("model.xml", Pendulum().Xml("", 4e-3));
    options_.folder = folder_;
  }
  IdentifyResult Result(const std::string& keys = kDamping) {
    return Identify(ReadExperiment(keys), ModelSpec::Load(folder_ / "model.xml"), options_);
  }

  IdentifyOptions options_;
};

TEST_F(IdentifyTest, ReturnsAllThatIsStatedOfAFit) {
  std::string how;
  options_.path = Path::kStepped;
  options_.accepted = [&](const std::string& words) { how = words; };
  const IdentifyResult result = Result();
  EXPECT_THAT(how, HasSubstr("path: stepped"));
  EXPECT_THAT(how, HasSubstr("1 parameters, 2 logs"));
  EXPECT_THAT(result.missing, IsEmpty());
  EXPECT_NEAR(result.fit.x[0], 0.1, 0.02);
  EXPECT_TRUE(result.uncertainty.known());
  EXPECT_THAT(result.logs, SizeIs(2));
  EXPECT_THAT(result.divergence, ::testing::Each(""));
  EXPECT_TRUE(result.ahead);
  EXPECT_FALSE(result.at_step);
  EXPECT_THAT(result.fitted.xml, HasSubstr("<mujoco"));
  EXPECT_THAT(result.fitted.yaml, HasSubstr("model: fitted.xml"));
}

TEST_F(IdentifyTest, OnTheSmoothPathAlsoSimulatesAsTheModelSteps) {
  options_.path = Path::kSmooth;
  options_.for_step = true;
  const IdentifyResult result = Result();
  ASSERT_TRUE(result.at_step);
  EXPECT_EQ(result.at_step->timestep, 4e-3);
  EXPECT_THAT(result.at_step->logs, SizeIs(2));
  EXPECT_NE(result.at_step->x[0], result.fit.x[0]);
}

// Where the fit at a fine step fails in a way that nobody thought of.
TEST_F(IdentifyTest, APartThatThrowsCostsOnlyItself) {
  options_.path = Path::kStepped;
  options_.progress = [](const Progress& progress) {
    if (progress.stage == "fit at a fine step") throw std::runtime_error("no terminal");
  };
  const IdentifyResult result = Result();
  ASSERT_THAT(result.missing, SizeIs(1));
  EXPECT_EQ(result.missing[0].InWords(), "intervals: no terminal");
  EXPECT_FALSE(result.uncertainty.known());
  EXPECT_EQ(result.uncertainty.lacks, "not computed: no terminal");
  EXPECT_NEAR(result.fit.x[0], 0.1, 0.02);
  EXPECT_TRUE(result.ahead);
}

class IdentifyReplicatesTest : public Bench {
 protected:
  // Two repetitions by a pendulum with a payload [kg] that its model lacks.
  std::string Said(double payload) {
    const auto u = Command(0, 100);
    const auto angle = Pendulum{.payload = payload}.Run(u, testing::kPeriod);
    for (const int seed : {1, 2})
      AddLog("r" + std::to_string(seed), "trial: one, use: train", u, Noisy(angle, 1e-3, 0, seed));
    Write("model.xml", Pendulum().Xml("", 1e-3));
    const Experiment e = ReadExperiment(kDamping);
    IdentifyOptions options;
    options.path = Path::kStepped, options.folder = folder_;
    return OverNoiseInWords(Identify(e, ModelSpec::Load(folder_ / "model.xml"), options));
  }
};

TEST_F(IdentifyReplicatesTest, OfARightModelLeaveTheirNoise) { EXPECT_EQ(Said(0), ""); }

TEST_F(IdentifyReplicatesTest, DoubtTheIntervalsOfAModelThatIsNotQuiteTheirs) {
  EXPECT_THAT(Said(0.015), HasSubstr("true values may lie outside of these intervals"));
}

TEST_F(IdentifyReplicatesTest, LackSomethingWhereMuchIsLeft) {
  EXPECT_THAT(Said(0.03), HasSubstr("the model lacks something"));
}

TEST_F(IdentifyTest, RefusesOptionsThatDoNotGoTogether) {
  options_.method = FitMethod::kParticleSwarm;
  options_.starts = 3;
  EXPECT_THROW(Result(), Error);
  options_ = {};
  options_.path = Path::kSmooth;
  options_.differences = 0.1;
  EXPECT_THROW(Result(), Error);
}

}  // namespace
}  // namespace continuum
