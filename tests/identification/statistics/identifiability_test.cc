#include "identification/statistics/identifiability.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/fit/intervals.h"
#include "identification/statistics/uncertainty.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Pendulum;

// m x'' = g u − k x − c x': all four may grow together.
constexpr const char* kSlide =
    "<mujoco><option gravity='0 0 0' timestep='1e-3'/><worldbody><body name='b'><joint name='x' "
    "type='slide' axis='1 0 0' stiffness='20' damping='0.8'/><inertial pos='0 0 0' mass='0.5' "
    "diaginertia='1 1 1'/></body></worldbody><actuator><motor name='servo' joint='x'/></actuator>"
    "<sensor><jointpos name='angle' joint='x'/></sensor></mujoco>";
const std::string
    kK = "{name: k, target: 'joint:x', attribute: stiffness, lower: 1, upper: 99}",
    kC = "{name: c, target: 'joint:x', attribute: damping, lower: 0, upper: 9}",
    kM = "{name: m, target: 'body:b', attribute: mass, lower: 0.1, upper: 9}",
    kG = "{name: g, target: 'actuator:servo', attribute: 'gainprm[0]', lower: 0.1, upper: 9}",
    kU = "{name: u, target: 'actuator:servo', attribute: 'gear', lower: 0.1, upper: 9}";

class TradeOffTest : public testing::Bench {
 protected:
  void AddTrials() {
    for (int t = 0; t < 2; ++t) {
      const auto u = Command(t, 200);
      AddLog("t" + std::to_string(t), "use: train", u, Pendulum().Run(u, testing::kPeriod));
    }
  }
};

TEST_F(TradeOffTest, SaysWhichParametersTradeOff) {
  AddTrials();
  const ModelSpec system = ModelSpec::Load(Write("model.xml", kSlide));
  const auto trade_offs = [&](const std::string& parameters) {
    const Experiment e = ReadExperiment("parameters: [" + parameters + "]\n");
    const Problem problem(e, system);
    const auto x = problem.Start();
    const auto r = problem.Residuals(x, problem.AllLogs());
    const auto J = problem.Jacobian(x, r, problem.AllLogs());
    return ConfoundingsOf(problem, x, UncertaintyOf(problem, x, r, J));
  };
  EXPECT_TRUE(trade_offs(kK + ", " + kC + ", " + kM).empty());
  const auto all = trade_offs(kK + ", " + kC + ", " + kM + ", " + kG);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_THAT(all[0].names, ElementsAre("k", "c", "m", "g"));
  EXPECT_GT(all[0].freedom, 100);
  EXPECT_THAT(all[0].text, HasSubstr("k, c, m and g trade off"));
  EXPECT_THAT(all[0].text, HasSubstr("only their ratios are determined"));
  const auto two = trade_offs(kG + ", " + kU);
  ASSERT_EQ(two.size(), 1u);
  EXPECT_THAT(two[0].text, HasSubstr("only g*u is"));
}

TEST_F(TradeOffTest, TellsSeveralTiesOfTheSameParametersOnce) {
  AddTrials();
  const ModelSpec system = ModelSpec::Load(Write("model.xml", kSlide));
  const Experiment e =
      ReadExperiment("parameters: [" + kK + ", " + kC + ", " + kM + ", " + kG + ", " + kU + "]\n");
  const Problem problem(e, system);
  const auto x = problem.Start();
  const auto u = IntervalsOf(problem, x, problem.Residuals(x, problem.AllLogs()));
  const auto ties = ConfoundingsOf(problem, x, u);
  ASSERT_EQ(ties.size(), 1u);
  EXPECT_EQ(
      ties[0].text,
      "k, c, m, g and u trade off: 2 independent changes of them change nothing that is measured; "
      "only 3 combinations of them are determined");
}

// A spring beside the joint's, and two factors of the same force.
TEST_F(TradeOffTest, TellsTiesThatHaveNothingToDoWithEachOtherApart) {
  AddTrials();
  std::string xml = kSlide;
  xml.insert(xml.find("<actuator>"),
             "<tendon><fixed name='rope' stiffness='5'><joint joint='x' coef='1'/></fixed>"
             "</tendon>");
  const ModelSpec system = ModelSpec::Load(Write("model.xml", xml));
  const Experiment e = ReadExperiment(
      "parameters: [" + kK + ", " + kG + ", " + kU +
      ", {name: t, target: 'tendon:rope', attribute: stiffness, lower: 1, upper: 99}]\n");
  const Problem problem(e, system);
  const auto x = problem.Start();
  const auto u = IntervalsOf(problem, x, problem.Residuals(x, problem.AllLogs()));
  const auto ties = ConfoundingsOf(problem, x, u);
  ASSERT_EQ(ties.size(), 2u);
  EXPECT_THAT(ties[0].names, ElementsAre("k", "t"));
  EXPECT_THAT(ties[0].text, HasSubstr("only one combination of them is determined"));
  EXPECT_THAT(ties[1].names, ElementsAre("g", "u"));
  EXPECT_THAT(ties[1].text, HasSubstr("only g*u is determined"));
}

// However far the slopes are taken because of the time step.
TEST_F(TradeOffTest, WhatNothingDeterminesReachesOverItsBounds) {
  AddTrials();
  const ModelSpec system = ModelSpec::Load(Write("model.xml", kSlide));
  for (const std::string& parameters : {kG + ", " + kU, kK + ", " + kC + ", " + kM + ", " + kG}) {
    const Experiment e = ReadExperiment("parameters: [" + parameters + "]\n");
    Problem problem(e, system);
    problem.StepBy(4e-3);
    const auto x = problem.Start();
    const auto u = IntervalsOf(problem, x, problem.Residuals(x, problem.AllLogs()));
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const FreeParameter& p = problem.parameters()[i];
      EXPECT_EQ(u.lower[i], p.lower) << p.name;
      EXPECT_EQ(u.upper[i], p.upper) << p.name;
    }
    const auto ties = ConfoundingsOf(problem, x, u);
    ASSERT_EQ(ties.size(), 1u) << parameters;
    EXPECT_THAT(ties[0].text, HasSubstr("change nothing that is measured"));
    if (x.size() == 2) {
      EXPECT_NEAR(u.correlation(0, 1), -1, 1e-3);
    }
  }
}

}  // namespace
}  // namespace continuum
