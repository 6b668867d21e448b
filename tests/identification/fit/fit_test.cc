#include "identification/fit/fit.h"
#include "identification/problem/start_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "error.h"
#include "identification/fit/intervals.h"
#include "support/pendulum_fit.h"

namespace continuum {
namespace {

using testing::Command;
using testing::CoulombInstance;
using ::testing::ElementsAre;
using testing::FitTest;
using ::testing::HasSubstr;
using testing::kBob;
using testing::kDamping;
using testing::kFriction;
using testing::Noisy;
using testing::Pendulum;

// 2 %: a step of h lets a held input act h/2 early, which k_p h/2 of damping makes up for: 1.25 %
// of the damping here; noise of 0.2 mrad over 600 rows moves the values by less than 0.1 %.
TEST_F(FitTest, RecoversMassAndBothFrictionsOfAPendulumItDidNotSimulate) {
  Pendulum truth;
  truth.tau_c = 0.12;
  AddTrials(truth, 3, 2e-4);
  const ModelSpec system = Model({}, CoulombInstance(0.01));
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kFriction + kBob);
  const Problem problem(e, system);
  const Fit fit = FitAll(problem);
  EXPECT_TRUE(fit.converged) << fit.message;
  EXPECT_NEAR(fit.x[0], truth.damping, 0.02 * truth.damping);
  EXPECT_NEAR(fit.x[1], truth.tau_c, 0.02 * truth.tau_c);
  // "mass" scales the inertia about the centre with it, which the truth has at 0.3 kg as well.
  EXPECT_NEAR(fit.x[2], truth.bob, 0.02 * truth.bob);
  RecordProperty("damping_error", std::to_string(fit.x[0] / truth.damping - 1));
  RecordProperty("tau_c_error", std::to_string(fit.x[1] / truth.tau_c - 1));
  RecordProperty("bob_error", std::to_string(fit.x[2] / truth.bob - 1));
  EXPECT_TRUE(std::is_sorted(fit.trace.rbegin(), fit.trace.rend()));
  EXPECT_NEAR(fit.cost, 0.5 * SumOfSquares(problem.Residuals(fit.x, problem.AllLogs())),
              1e-9 * fit.cost);
  EXPECT_EQ(fit.evaluations, problem.evaluations() - 3);
}

TEST_F(FitTest, RefusesTwoParametersThatDoTheSameAndNamesBoth) {
  AddTrials({}, 1);
  const ModelSpec system = Model({});
  const auto with = [&](const std::string& first, const std::string& second) -> std::string {
    const Experiment e =
        ReadExperiment(fmt::format("parameters:\n  - {{name: one, {0}, lower: 0.1, upper: 9}}\n"
                                   "  - {{name: two, {1}, lower: 0.1, upper: 9}}\n",
                                   first, second));
    try {
      const Problem problem(e, system);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string scale = "target: 'joint:hinge', attribute: damping, operation: scale";
  EXPECT_THAT(with(scale, "target: 'joint:h*', attribute: 'damping[0]', operation: scale"),
              AllOf(HasSubstr("experiment.yaml:"), HasSubstr("'one'"), HasSubstr("'two'")));
  const std::string mass = "initial: 1, attribute: mass, operation: scale, target: 'body:";
  EXPECT_EQ(with(mass + "*'", mass + "tip'"), "accepted");
  EXPECT_EQ(with("target: 'joint:hinge', attribute: damping", scale), "accepted");
  EXPECT_EQ(with(scale + ", frozen: true", scale), "accepted");
  EXPECT_THAT(with("initial: 1, target: 'sensor:angle', attribute: scale",
                   "initial: 1, target: 'sensor:angle', attribute: scale, per: log"),
              HasSubstr("the same: sensor:angle, scale"));
}

TEST_F(FitTest, NamesAParameterWithoutEffectBeforeItFits) {
  AddTrials({}, 1);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n" + kDamping +
      "  - {name: east, target: option, attribute: 'gravity[1]', initial: 0, lower: -1, upper: "
      "1}\n");
  const Problem problem(e, system);
  try {
    FitAll(problem);
    FAIL() << "a force along the axis of the joint moves nothing";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("parameter 'east' (option, gravity[1])"));
    EXPECT_EQ(error.exit_code(), 2);
  }
}

// Far above the truth the damping acts as 1/b: a full Gauss-Newton step goes deep below zero, where
// the pendulum takes up energy without end.
TEST_F(FitTest, AStepIntoDivergenceIsRejected) {
  AddTrials({}, 2, 2e-4);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, initial: 8, lower: "
      "-50, upper: 50}\n");
  const Problem problem(e, system);
  const auto use = problem.TrainLogs();
  const auto start = problem.Start();
  const auto r = problem.Residuals(start, use);
  const auto J = problem.Jacobian(start, r, use);
  double g = 0, h = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    g += J[l].col(0).dot(r[l]);
    h += J[l].col(0).squaredNorm();
  }
  auto full = start;
  full[0] -= g / h;
  const auto there = problem.Residuals(problem.Clamp(full), use);
  ASSERT_FALSE(there[0].allFinite() && there[1].allFinite()) << "b = " << full[0];
  const Fit fit = FitAll(problem);
  EXPECT_NEAR(fit.x[0], 0.1, 0.02 * 0.1) << fit.message;
}

TEST_F(FitTest, AStartThatDivergesIsAJobThatFailed) {
  AddTrials({}, 1);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, initial: -5, lower: "
      "-50, upper: 50}\n");
  const Problem problem(e, system);
  try {
    FitAll(problem);
    FAIL() << "damping of -5 N m s/rad cannot be simulated";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 1);
  }
}

TEST_F(FitTest, SlopesThatAreNoNumbersNameTheirParameters) {
  AddTrials({}, 1);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kBob);
  const Problem problem(e, system);
  std::vector<Problem::Matrix> J(1, Problem::Matrix::Zero(kRows, 2));
  EXPECT_NO_THROW(RequireFiniteSlopes(problem, problem.Start(), J));
  J[0](3, 1) = std::numeric_limits<double>::quiet_NaN();
  try {
    RequireFiniteSlopes(problem, problem.Start(), J);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("a little: bob = 0.2 ("));
    EXPECT_THAT(error.what(), HasSubstr("experiment.yaml:"));
    EXPECT_EQ(error.exit_code(), 1);
  }
}

TEST_F(FitTest, ParametersHaveANameAndABoundAboveTheOther) {
  AddTrials({}, 1);
  for (const auto& [line, word] :
       {std::pair{"name: ' ', lower: 0", "name: expected a name, found none"},
        std::pair{"name: b, lower: 2", "upper: expected a number above lower, 2, found 1"}}) {
    try {
      ReadExperiment(std::string("parameters:\n  - {") + line +
                     ", target: 'joint:hinge', attribute: damping, upper: 1}\n");
      FAIL() << line;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(word));
    }
  }
}

TEST_F(FitTest, AStartBesideWhichItDivergesIsLeftOnTheOtherSide) {
  AddTrials({}, 1);
  const ModelSpec system = Model({});
  const auto parameters = [&](double b) {
    return ReadExperiment(fmt::format(
        "parameters:\n  - {{name: b, target: 'joint:hinge', attribute: damping, initial: {:.17g}, "
        "lower: -50, upper: 50}}\n",
        b));
  };
  double stable = 0, diverging = -5;  // damping, between which the last that can be simulated lies
  for (int k = 0; k < 40; ++k) {
    const double b = (stable + diverging) / 2;
    const Experiment e = parameters(b);
    const Problem problem(e, system);
    const auto r = problem.Residuals(problem.Start(), problem.TrainLogs());
    (r[0].allFinite() ? stable : diverging) = b;
  }
  const Experiment e = parameters(stable);
  Problem problem(e, system);
  problem.Center();
  const Fit fit = FitAll(problem);
  EXPECT_LT(fit.cost, 0.5 * fit.trace.front()) << "from " << stable << " beside " << diverging;
}

// MuJoCo reads a positive velocity bias of a servo as a damping ratio.
TEST_F(FitTest, ANegativeServoDampingIsNotTakenForSomethingElse) {
  const ModelSpec system = Model({});
  EXPECT_THROW(system.Build(std::vector<Change>{{"actuator:servo", "kv", -1}}), Error);
}

class Conditions : public FitTest {
 protected:
  // Two trials of each of two conditions that differ in the servo's stiffness.
  void AddConditions() {
    for (const auto& [condition, kp] : {std::pair{"soft", 4.0}, std::pair{"stiff", 8.0}}) {
      Pendulum p;
      p.kp = kp;
      for (int t = 0; t < 2; ++t) {
        const auto u = Command(t, kRows);
        AddLog(std::string(condition) + std::to_string(t),
               std::string("use: ") + (t ? "validate" : "train") + ", condition: " + condition, u,
               p.Run(u, testing::kPeriod));
      }
    }
  }
};

const std::string kGain =
    "  - {name: kp, target: 'actuator:servo', attribute: kp, initial: 5, lower: 1, upper: 20, per: "
    "condition}\n";

TEST_F(Conditions, GiveAParameterOfTheirOwnEach) {
  AddConditions();
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kGain + kDamping);
  const Problem problem(e, system);
  ASSERT_EQ(problem.parameters().size(), 3u);
  EXPECT_EQ(problem.parameters()[0].name, "kp[soft]");
  EXPECT_EQ(problem.parameters()[1].name, "kp[stiff]");
  EXPECT_THAT(problem.parameters()[0].log, ElementsAre(true, true, false, false));
  const Fit fit = FitAll(problem);
  EXPECT_NEAR(fit.x[0], 4, 0.02 * 4);
  EXPECT_NEAR(fit.x[1], 8, 0.02 * 8);
  EXPECT_NEAR(fit.x[2], 0.1, 0.02 * 0.1);
  auto use = problem.TrainLogs();
  use.flip();
  // The held-out trials of the same conditions follow: 1 mrad is a tenth of a percent of the range.
  EXPECT_LT(problem.PooledRms(problem.Residuals(fit.x, use), use), 1e-3);
}

TEST_F(Conditions, WithoutATrainLogAreAnError) {
  AddConditions();
  const auto u = Command(2, kRows);
  AddLog("odd", "use: validate, condition: odd", u, Pendulum().Run(u, testing::kPeriod));
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kGain);
  try {
    const Problem problem(e, system);
    FAIL() << "nothing says how large kp[odd] is";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("'odd'"));
    EXPECT_THAT(error.what(), HasSubstr("experiment.yaml:"));
    EXPECT_EQ(error.exit_code(), 2);
  }
}

TEST_F(FitTest, PerLogExpandsToTheLabels) {
  AddTrials({}, 2);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1, "
      "per: log}\n");
  const Problem problem(e, system);
  ASSERT_EQ(problem.parameters().size(), 2u);
  EXPECT_EQ(problem.parameters()[0].name, "b[t0]");
  EXPECT_EQ(problem.parameters()[1].name, "b[t1]");
  EXPECT_EQ(problem.parameters()[0].initial, 0.1);  // what the model has
}

TEST_F(FitTest, AValueOfEachLogsOwnNeedsAFitThatSeesThemAll) {
  AddTrials({}, 1);
  const auto u = Command(1, kRows);
  AddLog("held", "use: validate", u, Pendulum().Run(u, testing::kPeriod));
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1, "
      "per: log}\n");
  try {
    const Problem problem(e, system);
    FAIL() << "nothing says how large b[held] is";
  } catch (const Error& error) {
    for (const char* word : {"experiment.yaml:", "parameters[0].per", "'held'", "use: train",
                             "identify --all", "per: condition"})
      EXPECT_THAT(error.what(), HasSubstr(word));
  }
  const Problem all(e, system, {}, {}, {true, true});
  ASSERT_EQ(all.parameters().size(), 2u);
  const Fit fit = FitParameters(all, all.Start(), all.seen());
  const auto intervals = IntervalsOf(all, fit.x, all.Residuals(fit.x, all.AllLogs()));
  for (const Eigen::Index k : {0, 1}) {
    EXPECT_NEAR(fit.x[k], 0.1, 0.02 * 0.1) << all.parameters()[k].name;
    EXPECT_LT(intervals.standard_error[k], 0.01) << all.parameters()[k].name;
  }
}

TEST_F(FitTest, ScaleAndAddActOnWhatTheModelAndTheLogHave) {
  Pendulum truth;
  truth.kp = 6;
  truth.damping = 0.13;
  truth.bob = 0.3;
  const auto u = Command(0, kRows);
  AddLog("model", "use: train", u, truth.Run(u, testing::kPeriod));
  truth.kp = 9;  // the log says 7.5, the scale is 1.2 again
  AddLog("set", "use: train, set: {'actuator:servo': {kp: 7.5}}", u,
         truth.Run(u, testing::kPeriod));
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: k, target: 'actuator:servo', attribute: kp, operation: scale, lower: 0.5, upper: "
      "2}\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, operation: add, lower: -0.05, "
      "upper: 0.5}\n");
  const Problem problem(e, system);
  EXPECT_EQ(problem.parameters()[0].initial, 1);
  EXPECT_EQ(problem.parameters()[0].unit, "1");
  EXPECT_EQ(problem.parameters()[1].initial, 0);
  const Fit fit = FitAll(problem);
  EXPECT_NEAR(fit.x[0], 1.2, 0.02 * 1.2);
  EXPECT_NEAR(fit.x[1], 0.03, 0.02 * 0.13);
}

TEST_F(FitTest, AFrozenParameterActsButDoesNotMove) {
  Pendulum truth;
  truth.damping = 0.2;
  AddTrials(truth, 2);
  const ModelSpec system = Model({});
  const std::string frozen =
      "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.2, lower: 0, upper: 1, "
      "frozen: true}\n";
  const Experiment e = ReadExperiment("parameters:\n" + frozen + kBob);
  const Problem problem(e, system);
  ASSERT_EQ(problem.parameters().size(), 1u);
  EXPECT_EQ(problem.parameters()[0].name, "bob");
  EXPECT_NEAR(FitAll(problem).x[0], truth.bob, 0.02 * truth.bob);
}

TEST_F(FitTest, ASoftLossIsNotDrawnByOutliers) {
  AddTrials({}, 2, 2e-4);
  const ModelSpec system = Model({});
  Experiment e = ReadExperiment("parameters:\n" + kDamping);
  for (std::size_t k = kRows - 1; k > 10; k -= 10) {  // a tenth of the rows is 80 ms late
    for (Log& log : e.logs) log.measured[0][k] = log.measured[0][k - 8];
  }
  const Problem problem(e, system);
  const auto fit = [&](double soft) {
    FitOptions options;
    options.soft = soft;
    return FitParameters(problem, problem.Start(), problem.AllLogs(), options).x[0];
  };
  const double robust = std::abs(fit(0.002) - 0.1);
  EXPECT_LT(robust, 0.02 * 0.1);
  EXPECT_LT(robust, 0.2 * std::abs(fit(0) - 0.1));
  const auto error = [&](double soft) {
    e.soft = soft;
    const Problem judged(e, system);
    const Problem::Vector x = Problem::Vector::Constant(1, 0.1);
    return IntervalsOf(judged, x, judged.Residuals(x, judged.AllLogs())).standard_error[0];
  };
  EXPECT_LT(error(0.002), 0.2 * error(0));
}

TEST_F(FitTest, WithoutTimeItEndsWhereItBegins) {
  AddTrials({}, 1, 2e-3);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kDamping);
  const Problem problem(e, system);
  FitOptions options;
  options.until = 0;
  const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs(), options);
  EXPECT_EQ(fit.x, problem.Start());
  EXPECT_FALSE(fit.converged);
  EXPECT_EQ(fit.message, "out of time");
  EXPECT_EQ(fit.evaluations, 1u);
  const auto r = problem.Residuals(problem.Start(), problem.TrainLogs());
  EXPECT_DOUBLE_EQ(fit.cost, 0.5 * SumOfSquares(r));
}

TEST_F(FitTest, ChordsReachTheSameOptimumFromNearby) {
  AddTrials({}, 3, 2e-3);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kBob);
  const Problem problem(e, system);
  const auto all = problem.AllLogs();
  const Fit fit = FitAll(problem);
  const auto J = problem.Jacobian(fit.x, problem.Residuals(fit.x, all), all);
  const std::vector<bool> two{true, true, false};
  const auto chords = RefitByChords(problem, fit.x, problem.Residuals(fit.x, all), J, two);
  const Fit full = FitParameters(problem, fit.x, two);
  EXPECT_LE(SumOfSquares(problem.Residuals(chords, two)),
            SumOfSquares(problem.Residuals(fit.x, two)));
  // Both end where a step lowers the cost by less than 1e-4 of it.
  EXPECT_NEAR(0.5 * SumOfSquares(problem.Residuals(chords, two)), full.cost, 1e-3 * full.cost);
}

}  // namespace
}  // namespace continuum
