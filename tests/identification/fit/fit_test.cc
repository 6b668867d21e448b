#include "identification/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "benchmark/stick_slip/experiment.h"
#include "error.h"
#include "identification/fit/intervals.h"
#include "identification/statistics/uncertainty.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::CoulombInstance;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;

const std::string kDamping =
    "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.05, lower: 0, upper: 1}\n";
const std::string kFriction =
    "  - {name: tau_c, target: 'plugin:dry', attribute: tau_c, initial: 0.01, lower: 0, upper: "
    "1}\n";
const std::string kBob =
    "  - {name: bob, target: 'body:arm', attribute: mass, initial: 0.2, lower: 0.05, upper: 1}\n";

class FitTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 200;

  ModelSpec Model(const Pendulum& p, const std::string& extension = "", double timestep = 5e-4) {
    return ModelSpec::Load(Write("model.xml", p.Xml(extension, timestep)));
  }
  // Trials of a pendulum with noise, all for training.
  void AddTrials(const Pendulum& p, int count, double sigma = 0) {
    for (int t = 0; t < count; ++t) {
      const auto u = Command(t, kRows);
      AddLog("t" + std::to_string(t), "use: train", u,
             Noisy(p.Run(u, testing::kPeriod), sigma, 0, static_cast<unsigned>(t + 1)));
    }
  }
  static Fit FitAll(const Problem& problem) {
    return FitParameters(problem, problem.Start(), problem.TrainLogs());
  }
};

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

// Each interval misses with 5 %: of 20, more than 4 do so with a probability of 0.26 %.
TEST_F(FitTest, IntervalsHoldTheTruthUnderNoiseThatLastsTenRows) {
  constexpr int kSeeds = 20;
  Pendulum truth;
  truth.tau_c = 0.12;
  const ModelSpec system = Model({}, CoulombInstance(0.05), 1e-3);
  std::vector<std::vector<double>> clean;
  for (int t = 0; t < 2; ++t) clean.push_back(truth.Run(Command(t, kRows), testing::kPeriod));
  std::vector<int> covered(3, 0);
  const double values[] = {truth.damping, truth.tau_c, truth.bob};
  AddTrials(truth, 2);
  Experiment e = ReadExperiment("parameters:\n" + kDamping + kFriction + kBob);
  for (int seed = 0; seed < kSeeds; ++seed) {
    for (std::size_t t = 0; t < 2; ++t) {
      e.logs[t].measured[0] =
          Noisy(clean[t], 0.01, 0.9, static_cast<unsigned>(100 * seed + static_cast<int>(t)));
    }
    const Problem problem(e, system);
    const Problem::Vector near = Eigen::Map<const Problem::Vector>(values, 3);
    const Fit fit = FitParameters(problem, near, problem.TrainLogs(), {4, 1e-3});
    const auto r = problem.Residuals(fit.x, problem.TrainLogs());
    const auto u =
        UncertaintyOf(problem, fit.x, r, problem.Jacobian(fit.x, r, problem.TrainLogs()));
    for (Eigen::Index i = 0; i < 3; ++i) {
      covered[i] += u.lower[i] <= values[i] && values[i] <= u.upper[i];
      // An interval that says nothing would cover as well.
      EXPECT_LT(u.upper[i] - u.lower[i], values[i]) << "seed " << seed << ", parameter " << i;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    RecordProperty("covered_" + std::to_string(i), covered[i]);
    EXPECT_GE(covered[i], kSeeds - 4) << "parameter " << i;
  }
}

TEST_F(FitTest, IntervalsAreWiderForNoiseThatLasts) {
  Pendulum truth;
  const ModelSpec system = Model({});
  AddTrials(truth, 2);
  Experiment e = ReadExperiment("parameters:\n" + kDamping);
  const auto clean = std::vector{e.logs[0].measured[0], e.logs[1].measured[0]};
  const auto error = [&](double rho) {
    for (unsigned t = 0; t < 2; ++t) e.logs[t].measured[0] = Noisy(clean[t], 0.01, rho, 5 + t);
    const Problem problem(e, system);
    const Problem::Vector x = FitAll(problem).x;
    const auto r = problem.Residuals(x, problem.AllLogs());
    return UncertaintyOf(problem, x, r, problem.Jacobian(x, r, problem.AllLogs()))
        .standard_error[0];
  };
  EXPECT_GT(error(0.9), 1.5 * error(0));
}

// Of an area in m² and of a cubic spring in N/m³ one is 1e-5 and the other 1e5.
TEST_F(FitTest, ErrorsFollowTheUnitsOfTheirParameters) {
  AddTrials({}, 1, 0.01);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kBob);
  const Problem problem(e, system);
  const Problem::Vector x = problem.Start();
  const auto r = problem.Residuals(x, problem.AllLogs());
  auto J = problem.Jacobian(x, r, problem.AllLogs());
  const auto plain = UncertaintyOf(problem, x, r, J);
  J[0].col(0) *= 1e-6, J[0].col(1) *= 1e6;
  const auto scaled = UncertaintyOf(problem, x, r, J);
  EXPECT_NEAR(1e-6 * scaled.standard_error[0] / plain.standard_error[0], 1, 1e-6);
  EXPECT_NEAR(1e6 * scaled.standard_error[1] / plain.standard_error[1], 1, 1e-6);
  EXPECT_NEAR(scaled.correlation(0, 1), plain.correlation(0, 1), 1e-6);
}

TEST_F(FitTest, StopsAtABoundAndSaysHowFarFromItTheValueMayBe) {
  AddTrials({}, 2, 2e-4);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.2, lower: 0.15, upper: "
      "1}\n" +
      kBob);
  const Problem problem(e, system);
  const Fit fit = FitAll(problem);
  EXPECT_EQ(fit.x[0], 0.15);
  const auto r = problem.Residuals(fit.x, problem.AllLogs());
  const auto u = UncertaintyOf(problem, fit.x, r, problem.Jacobian(fit.x, r, problem.AllLogs()));
  EXPECT_THAT(u.at_bound, ElementsAre(true, false));
  for (Eigen::Index i = 0; i < 2; ++i) EXPECT_GT(u.standard_error[i], 0);
  EXPECT_EQ(u.lower[0], 0.15);
  EXPECT_GT(u.upper[0], 0.15 + 1.9 * u.standard_error[0]);
}

// Exact logs of a slider that is stuck at two rows of three: what the step of 2 ms does to the
// values is known, to first order, by central differences (by one-sided ones the mass is 0.2 %
// off).
TEST_F(FitTest, WhereASliderSticksTheIntervalReachesOverTheTruth) {
  CONTINUUM_LONG_IF_SANITIZED("several fits");
  const Experiment e = stick_slip::Clean(folder_, 2e-3, 2e-4);
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  const Fit fit = FitAll(problem);
  const auto u = IntervalsOf(problem, fit.x, problem.Residuals(fit.x, problem.AllLogs()));
  for (std::size_t i = 0; i < stick_slip::kTrue.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double truth = stick_slip::kTrue[i];
    EXPECT_NEAR(fit.x[k], truth, 0.02 * truth) << stick_slip::kNames[i];
    EXPECT_NEAR(fit.x[k] + u.step[k], truth, 1e-3 * truth) << stick_slip::kNames[i];
    EXPECT_LT(u.lower[k], truth) << stick_slip::kNames[i];
    EXPECT_GT(u.upper[k], truth) << stick_slip::kNames[i];
  }
}

// The pendulum that made the log has a step of its own, far finer.
TEST_F(FitTest, ToldOfTheStepTheIntervalReachesOverTheValueOfAFineOne) {
  const Pendulum truth;
  AddTrials(truth, 2);
  const ModelSpec system = Model({}, "", 4e-3);
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kBob);
  const Problem problem(e, system);
  const Problem::Vector x = FitAll(problem).x;
  const auto use = problem.TrainLogs();
  const auto r = problem.Residuals(x, use);
  const auto J = problem.Jacobian(x, r, use);
  Uncertainty u = UncertaintyOf(problem, x, r, J);
  const double bias = x[0] - truth.damping;
  EXPECT_GT(std::abs(bias), 0.05 * truth.damping);
  EXPECT_FALSE(u.lower[0] <= truth.damping && truth.damping <= u.upper[0]);
  AllowForStep(problem, J, problem.StepEffects(x, r, use), {}, u);
  EXPECT_NEAR(u.step[0], -bias, 0.2 * std::abs(bias));
  EXPECT_TRUE(u.lower[0] <= truth.damping && truth.damping <= u.upper[0]);
}

// As in a narrow valley of a rough cost: slopes that hold over a tiny distance only.
TEST_F(FitTest, SecantsFindTheSlopesOverTheDistanceThatTheStepLeavesOpen) {
  AddTrials({}, 2);
  const ModelSpec system = Model({}, "", 4e-3);
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kBob);
  const Problem problem(e, system);
  const Problem::Vector x = FitAll(problem).x;
  const auto use = problem.TrainLogs();
  const auto r = problem.Residuals(x, use);
  const auto J = problem.Jacobian(x, r, use), step = problem.StepEffects(x, r, use);
  auto steep = J;
  for (auto& columns : steep) columns *= 30;
  const auto found = Secants(problem, x, r, steep, step, {});
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      EXPECT_LT((found[l].col(i) - J[l].col(i)).norm(), 0.2 * J[l].col(i).norm()) << i;
  }
}

TEST_F(FitTest, WithoutEffectAParameterMayBeAnythingThatItsBoundsAllow) {
  AddTrials({}, 1, 2e-4);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment("parameters:\n" + kDamping + kBob);
  const Problem problem(e, system);
  const Problem::Vector x = FitAll(problem).x;
  const auto r = problem.Residuals(x, problem.AllLogs());
  auto J = problem.Jacobian(x, r, problem.AllLogs());
  J[0].col(1).setZero();
  const Uncertainty u = UncertaintyOf(problem, x, r, J);
  EXPECT_NEAR(u.standard_error[1], 0.95 / std::sqrt(12), 1e-12);
  EXPECT_EQ(u.lower[1], 0.05);
  EXPECT_EQ(u.upper[1], 1);
  EXPECT_GT(u.standard_error[0], 0);
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
