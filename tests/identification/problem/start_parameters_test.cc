#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/fit/fit.h"
#include "identification/fit/intervals.h"
#include "identification/fit/start_hint.h"
#include "identification/problem/extended_model.h"
#include "identification/problem/path_choice.h"
#include "identification/problem/start_parameters.h"
#include "sim/replay/replay.h"
#include "sim/simulation/initial_state.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;

constexpr double kSigma = 1e-3;  // rad

/// One log of a pendulum that never rests, in three windows, the last held out.
class StartsTest : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    const auto u = Command(1, 600);
    AddLog("long", "use: train", u, Noisy(truth_.Run(u, testing::kPeriod), kSigma, 0, 7));
    logs_ =
        "  - {file: long.csv, trial: a, use: train, window: [0.5, 2.3]}\n"
        "  - {file: long.csv, trial: b, use: train, window: [2.4, 4.2]}\n"
        "  - {file: long.csv, trial: c, use: validate, window: [4.3, 5.9]}\n";
  }
  Experiment From(const std::string& start) const {
    Experiment e = ReadExperiment(
        "parameters:\n"
        "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.05, lower: 0, upper: "
        "1}\n"
        "  - {name: bob, target: 'body:arm', attribute: mass, initial: 0.2, lower: 0.05, upper: "
        "1}\n");
    e.start = start == "estimate" ? Experiment::Start::kEstimate : Experiment::Start::kMeasured;
    return e;
  }
  ModelSpec Model() const { return ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 5e-4))); }
  static Problem::Vector Fitted(const Problem& problem) {
    auto unseen = problem.TrainLogs();
    unseen.flip();
    return FitStarts(problem, FitParameters(problem, problem.Start(), problem.TrainLogs()).x,
                     unseen);
  }

  Pendulum truth_;
};

TEST_F(StartsTest, WindowsThatBeginInMotionGiveTheParameters) {
  const Experiment e = From("estimate");
  const Problem problem(e, Model());
  ASSERT_EQ(problem.parameters().size(), 2 + 2 * e.logs.size());
  const Problem::Vector x = Fitted(problem);
  EXPECT_NEAR(x[0], truth_.damping, 0.02 * truth_.damping);  // h/2 late inputs, see fit_test.cc
  EXPECT_NEAR(x[1], truth_.bob, 0.02 * truth_.bob);
  const auto r = problem.Residuals(x, problem.AllLogs());
  EXPECT_NEAR(problem.PooledRms(r, problem.AllLogs()), kSigma, 0.1 * kSigma);
}

// A free pendulum that falls from the top, l q'' = −g sin q, in rows of 10 ms with noise. Its fall
// magnifies what the first rows do not say of its speed: one linearisation there is not enough.
TEST_F(StartsTest, AHeldOutLogThatBeginsNearTheTopIsFollowed) {
  constexpr double kLength = 0.2, kStep = 1e-4;
  for (const double top : {3.0, 3.12}) {
    testing::ArNoise noise(kSigma, 0, top > 3.1 ? 1 : 2);
    std::string csv = "time,q\n";
    double q = top, v = 0;
    for (int k = 0; k < 25000; ++k) {
      if (k % 100 == 0) csv += fmt::format("{},{}\n", kStep * k, q + noise.Next());
      q += kStep / 2 * v, v -= kStep * 9.81 / kLength * std::sin(q), q += kStep / 2 * v;
    }
    Write(top > 3.1 ? "unseen.csv" : "seen.csv", csv);
  }
  const std::string model = R"(<mujoco><option timestep="1e-3" integrator="RK4"/><worldbody>
      <body name="arm"><joint name="hinge" axis="0 1 0"/><inertial pos="0 0 -0.2" mass="1"
      diaginertia="1e-9 1e-9 1e-9"/></body></worldbody><sensor><jointpos name="angle" joint="hinge"/>
      </sensor></mujoco>)";
  const Experiment e = Experiment::Read(Write(
      "top.yaml",
      "format: 1\nmodel: model.xml\nstart: estimate\nlogs:\n  - {file: seen.csv, trial: a, use: "
      "train}\n  - {file: unseen.csv, trial: b, use: validate}\noutputs:\n  - {column: q, unit: "
      "rad, sensor: angle}\nparameters:\n  - {name: b, target: 'joint:hinge', attribute: "
      "damping, lower: 0, upper: 1}\n"));
  const Problem problem(e, ModelSpec::Load(Write("model.xml", model)));
  const std::vector<bool> unseen{false, true};
  const auto rms = [&](const Problem::Vector& x) {
    return problem.PooledRms(problem.Residuals(x, unseen), unseen);
  };
  const Problem::Vector x = problem.Start();
  const auto r = problem.Residuals(x, unseen);
  EXPECT_GT(rms(RefitByChords(problem, x, r, problem.StartJacobian(x, r, unseen), unseen)),
            2 * kSigma);
  EXPECT_NEAR(rms(FitStarts(problem, x, unseen)), kSigma, 0.1 * kSigma);
}

TEST_F(StartsTest, WhereTheyBeginIsFarFromRestAndFromTheFirstRow) {
  const Experiment e = From("measured");
  const Problem problem(e, Model());
  const Problem::Vector x = Fitted(problem);
  const auto r = problem.Residuals(x, problem.AllLogs());
  EXPECT_GT(problem.PooledRms(r, problem.AllLogs()), 10 * kSigma);
  EXPECT_THAT(StartHint(problem, x, problem.TrainLogs()), HasSubstr("'start: estimate' 9"));
}

TEST_F(StartsTest, NoHintIsGivenWhereTheFirstRowsAreRight) {
  logs_ = "  - {file: long.csv, trial: a, use: train}\n";
  const Experiment e = From("measured");
  const Problem problem(e, Model());
  EXPECT_EQ(StartHint(problem, Fitted(problem), problem.TrainLogs()), "");
}

// A wheel at half the speed: its start is that of the arm, and not one more parameter.
TEST_F(StartsTest, OfTiedJointsAreThoseOfTheOthers) {
  std::string xml = Pendulum().Xml("", 5e-4);
  xml.insert(xml.find("<worldbody>") + 11,
             "<body><joint name='wheel'/>"
             "<inertial pos='0 0 0' mass='1' diaginertia='1e-4 1e-4 1e-4'/></body>");
  xml.insert(
      xml.find("<actuator>"),
      "<equality><joint joint1='wheel' joint2='hinge' polycoef='0.2 0.5 0 0 0'/></equality>");
  const ModelSpec system = ModelSpec::Load(Write("tied.xml", xml));
  const Experiment e = From("estimate");
  const Problem problem(e, system);
  ASSERT_EQ(problem.parameters().size(), 2 + 2 * e.logs.size());
  ModelAndData machine = system.Build();
  InitialState state{{0, 0.4}, {0, 1}};
  SetTiedJoints(machine, state);
  EXPECT_THAT(state.qpos, ::testing::ElementsAre(::testing::DoubleEq(0.4), 0.4));
  EXPECT_THAT(state.qvel, ::testing::ElementsAre(0.5, 1));
}

// The motor of an elastic gear begins where its spring is at rest.
TEST_F(StartsTest, OfAGearAreThoseOfItsJoint) {
  const ModelSpec rigid = Model();
  const ModelSpec system = rigid.With(
      {{{"joint:hinge", "armature", 0.01}, {"joint:hinge", "effect:elastic_gear.c", 0.02}}}, {});
  const Experiment e = From("estimate");
  const Problem problem(e, system);
  ASSERT_EQ(problem.parameters().size(), 2 + 2 * e.logs.size());
  ModelAndData machine = system.Build();
  const InitialState start = StartOf(machine, e, e.logs[0]);
  ASSERT_EQ(start.qpos.size(), 2u);
  EXPECT_NE(start.qpos[0], 0);
  EXPECT_EQ(start.qpos[1], start.qpos[0]);
  EXPECT_EQ(start.qvel[1], start.qvel[0]);
  InitialState moved{{0.4, 0}, {1, 0}};
  SetTiedJoints(machine, moved);
  EXPECT_EQ(moved.qpos[1], 0.4);
  EXPECT_EQ(moved.qvel[1], 1);
}

TEST_F(StartsTest, AHeldOutLogMovesNothingButItsOwnStart) {
  const Experiment e = From("estimate");
  const Problem problem(e, Model());
  const Problem::Vector before = problem.Start();
  const Problem::Vector after = FitStarts(problem, before, {false, false, true});
  for (Eigen::Index i = 0; i < before.size(); ++i) {
    const bool own = problem.parameters()[i].IsStart() && problem.parameters()[i].log[2];
    EXPECT_EQ(after[i] != before[i], own) << problem.parameters()[i].name;
  }
}

// As if its log had been one of the fit, but that all else is held then.
TEST_F(StartsTest, OfAHeldOutLogHaveTheErrorsThatItsOwnRowsGive) {
  const Experiment e = From("estimate");
  Experiment seen = e;
  seen.logs[2].train = true;
  const ModelSpec system = Model();
  const Problem problem(e, system), all(seen, system);
  const Problem::Vector x = Fitted(problem);
  const auto r = problem.Residuals(x, problem.AllLogs());
  const Uncertainty u = IntervalsOf(problem, x, r), with = IntervalsOf(all, x, r);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (!p.IsStart() || !p.log[2]) continue;
    EXPECT_LT(u.standard_error[i], 1.1 * with.standard_error[i]) << p.name;
    EXPECT_GT(u.standard_error[i], 0.2 * with.standard_error[i]) << p.name;
    EXPECT_LE(u.lower[i], x[i]) << p.name;
    EXPECT_GE(u.upper[i], x[i]) << p.name;
    EXPECT_NE(u.step[i], 0) << p.name;
  }
}

TEST_F(StartsTest, AreFollowedStepByStep) {
  const Experiment e = From("estimate");
  EXPECT_THAT(SmoothObstacle(Problem(e, Model())), HasSubstr("begin"));
}

TEST_F(StartsTest, TheExtendedExperimentBeginsThere) {
  const Experiment e = From("estimate");
  const Problem problem(e, Model());
  const Problem::Vector x = Fitted(problem);
  const ExtendedModel extension = Extend(problem, problem.system(), x, folder_);
  Write("extended.xml", extension.xml);
  Experiment extended = Experiment::Read(Write("extended.yaml", extension.yaml));
  const auto replayed = Replay(extended, ModelSpec::Load(extended.model));
  const auto r = problem.Residuals(x, problem.AllLogs());
  auto validate = problem.TrainLogs();
  validate.flip();
  const SplitError error = PooledError(extended, replayed);
  EXPECT_NEAR(error.train, problem.PooledRms(r, problem.TrainLogs()), 1e-9);
  EXPECT_NEAR(error.validate, problem.PooledRms(r, validate), 1e-9);
}

TEST_F(StartsTest, OfALogAreRefusedWithLineAndKey) {
  const auto refusal = [&](const std::string& start) -> std::string {
    logs_ = "  - {file: long.csv, start: " + start + "}\n";
    try {
      Problem(ReadExperiment(""), Model()).Predict({}, 0);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(refusal("{hinge: [0.1]}"), HasSubstr("experiment.yaml:5: logs[0].start.hinge"));
  EXPECT_THAT(refusal("{hinge: 0.1}"), HasSubstr("experiment.yaml:5: logs[0].start.hinge"));
  EXPECT_THAT(refusal("{knee: [0.1, 0]}"), HasSubstr("'knee'"));
  EXPECT_EQ(refusal("{hinge: [0.1, 0]}"), "nothing");
}

}  // namespace
}  // namespace continuum
