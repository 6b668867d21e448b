#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "benchmark/stick_slip/experiment.h"
#include "identification/fit/intervals.h"
#include "identification/statistics/uncertainty.h"
#include "support/long_test.h"
#include "support/pendulum_fit.h"

namespace continuum {
namespace {

using testing::Command;
using testing::CoulombInstance;
using ::testing::ElementsAre;
using testing::FitTest;
using testing::kBob;
using testing::kDamping;
using testing::kFriction;
using testing::Noisy;
using testing::Pendulum;

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

// Spring, damping, mass and gain grow together but for a small armature: a fit of few damped steps
// stays where it began along that.
TEST_F(FitTest, IntervalsReachOverTheValueOfAFineStepAlongWhatTheLogHardlyDetermines) {
  const auto model = [](const std::string& step) {
    return "<mujoco><option timestep='" + step +
           "' integrator='implicitfast'/><worldbody><body name='arm'><joint name='q' axis='0 1 0' "
           "stiffness='0.6' damping='0.02' armature='0.001'/><inertial pos='0 0 -0.15' mass='0.3' "
           "diaginertia='2e-3 2e-3 1e-4'/></body></worldbody><actuator><general name='u' "
           "joint='q' dyntype='filterexact' dynprm='0.08' gainprm='1.3'/></actuator><sensor>"
           "<jointpos name='q' joint='q'/></sensor></mujoco>";
  };
  std::string csv = "t,u,q\n";
  for (int k = 0; k <= 800; ++k) {
    const double t = 0.01 * k;
    csv += fmt::format("{:.2f},{:.9f},0\n", t,
                       std::min(1.0, 3 * t) * (0.25 * std::sin(4.4 * t) + 0.2 * std::sin(12 * t)));
  }
  Write("log.csv", csv);
  Experiment e = Experiment::Read(Write(
      "e.yaml",
      "format: 1\nmodel: " + Write("model.xml", model("2e-3")).string() +
          "\nstart: rest\ntime: {column: t, unit: s}\n"
          "inputs: [{column: u, unit: N*m, actuator: u, interpolate: linear}]\n"
          "outputs: [{column: q, unit: rad, sensor: q, sigma: 0.001}]\n"
          "logs: [{file: log.csv, use: train}]\nparameters:\n"
          "  - {name: k, target: 'joint:q', attribute: stiffness, initial: 0.6, lower: 0.1, "
          "upper: 2}\n"
          "  - {name: b, target: 'joint:q', attribute: damping, initial: 0.02, lower: 0, upper: "
          "1}\n"
          "  - {name: m, target: 'body:arm', attribute: mass, initial: 0.3, lower: 0.05, upper: "
          "1}\n"
          "  - {name: T, target: 'actuator:u', attribute: lag, initial: 0.08, lower: 0.01, upper: "
          "1}\n"
          "  - {name: g, target: 'actuator:u', attribute: 'gainprm[0]', initial: 1.3, lower: 0.2, "
          "upper: 4}\n"));
  const Problem truth(e, ModelSpec::Parse(model("1e-4")));
  const Problem::Vector values = truth.Start();
  e.logs[0].measured[0] = Noisy(truth.Predict(values, 0).channel[0], 1e-3, 0, 1);
  const Problem problem(e, ModelSpec::Parse(model("2e-3")));
  const Problem::Vector x = FitAll(problem).x;
  const auto u = IntervalsOf(problem, x, problem.Residuals(x, problem.TrainLogs()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    EXPECT_LT(u.lower[i], values[i]) << problem.parameters()[i].name;
    EXPECT_GT(u.upper[i], values[i]) << problem.parameters()[i].name;
    EXPECT_LT(std::abs(x[i] + u.step[i] - values[i]), 0.5 * std::abs(x[i] - values[i]))
        << problem.parameters()[i].name;
  }
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

}  // namespace
}  // namespace continuum
