#include "identification/inverse_dynamics/regressor.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/fit/swarm_fit.h"
#include "identification/inverse_dynamics/zero_phase_lowpass.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::CoulombInstance;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;

TEST(LowPassTest, HalvesTheCutoffWithoutPhaseAndLeavesTheRest) {
  constexpr double kCutoff = 0.05;
  for (const double share : {0.2, 1.0, 4.0}) {
    std::vector<double> y;
    const double w = 2 * std::numbers::pi * kCutoff * share;
    for (int k = 0; k < 2000; ++k) y.push_back(std::sin(w * k));
    const auto z = LowPass(y, kCutoff);
    double in = 0, out = 0, across = 0;  // amplitude and quadrature, away from the ends
    for (int k = 400; k < 1600; ++k) {
      in += y[k] * y[k], out += y[k] * z[k], across += std::cos(w * k) * z[k];
    }
    // Digital frequencies bend: the filter is exact at its cutoff.
    const double bend = std::tan(w / 2) / std::tan(std::numbers::pi * kCutoff);
    EXPECT_NEAR(out / in, 1 / (1 + std::pow(bend, 8)), 1e-3) << share;
    EXPECT_NEAR(across / in, 0, 1e-3) << share;
  }
}

TEST(LowPassTest, LeavesALineAlone) {
  std::vector<double> y;
  for (int k = 0; k < 100; ++k) y.push_back(3 + 0.5 * k);
  const auto z = LowPass(y, 0.1), v = Derivative(z, 0.01);
  for (int k = 0; k < 100; ++k) {
    EXPECT_NEAR(z[k], y[k], 1e-2);
    if (k > 20 && k < 80) {
      EXPECT_NEAR(v[k], 50, 1e-3);
    }
  }
}

class RegressorTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 400;
  void AddTrials(const Pendulum& p, double sigma) {
    for (int t = 0; t < 3; ++t) {
      const auto u = Command(t, kRows);
      AddLog("t" + std::to_string(t), t < 2 ? "use: train" : "use: validate", u,
             Noisy(p.Run(u, testing::kPeriod), sigma, 0, static_cast<unsigned>(t + 1)));
    }
  }
};

const std::string kBoth =
    "parameters:\n"
    "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.3, lower: 0, upper: 1}\n"
    "  - {name: tau_c, target: 'plugin:dry', attribute: tau_c, initial: 0.01, lower: 0, upper: "
    "1}\n";

// At rest dry friction is anything up to its level: with those rows tau_c came out 9 % low and b 4
// % high; what is left are rests shorter than the filter remembers. (Held inputs taken at the times
// of their rows added k_p h/2 to b, a quarter.)
TEST_F(RegressorTest, FindsFrictionWithoutASimulation) {
  Pendulum truth;
  truth.tau_c = 0.12;
  AddTrials(truth, 1e-4);
  const ModelSpec system =
      ModelSpec::Load(Write("model.xml", Pendulum{}.Xml(CoulombInstance(0.01))));
  const Experiment e = ReadExperiment(kBoth);
  const Problem problem(e, system);
  const Regression found = FitByRegressor(problem, problem.TrainLogs(), {.cutoff = 10});
  EXPECT_EQ(problem.evaluations(), 0u);
  EXPECT_NEAR(found.x[0], truth.damping, 0.02 * truth.damping);
  EXPECT_NEAR(found.x[1], truth.tau_c, 0.03 * truth.tau_c);
  EXPECT_LT(found.train, 10);
  EXPECT_LT(found.validate, 10);
  EXPECT_GT(found.uncertainty.standard_error[0], 0);
}

// Held most of the time.
TEST_F(RegressorTest, LearnsNothingOfFrictionFromRests) {
  Pendulum truth;
  truth.tau_c = 0.12;
  std::vector<double> u;
  for (std::size_t k = 0; k < kRows; ++k) u.push_back(0.15 * static_cast<double>(k / 80 % 3));
  AddLog("stairs", "use: train", u, Noisy(truth.Run(u, testing::kPeriod), 1e-4, 0, 1));
  const ModelSpec system =
      ModelSpec::Load(Write("model.xml", Pendulum{}.Xml(CoulombInstance(0.01))));
  const Experiment e = ReadExperiment(kBoth);
  const Problem problem(e, system);
  const Regression found = FitByRegressor(problem, problem.TrainLogs());
  EXPECT_NEAR(found.x[0], truth.damping, 0.05 * truth.damping);
  EXPECT_NEAR(found.x[1], truth.tau_c, 0.08 * truth.tau_c);
  EXPECT_LT(found.rows, kRows / 2);
}

// A wheel at half the speed feels like a quarter of its inertia and damping.
TEST_F(RegressorTest, JointsThatAreTiedToMeasuredOnesFollowThem) {
  Pendulum truth;
  truth.inertia += 0.25 * 4e-3;
  truth.damping += 0.25 * 0.08;
  AddTrials(truth, 1e-4);
  std::string xml = Pendulum{}.Xml();
  xml.insert(xml.find("<worldbody>") + 11,
             "<body><joint name='wheel' damping='0.3'/>"
             "<inertial pos='0 0 0' mass='1' diaginertia='4e-3 4e-3 4e-3'/></body>");
  xml.insert(
      xml.find("<actuator>"),
      "<equality><joint joint1='wheel' joint2='hinge' polycoef='0.2 0.5 0 0 0'/></equality>");
  const ModelSpec system = ModelSpec::Load(Write("model.xml", xml));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: b, target: 'joint:wheel', attribute: damping, lower: 0, upper: 1}\n");
  const Problem problem(e, system);
  const Regression found = FitByRegressor(problem, problem.TrainLogs(), {.cutoff = 10});
  EXPECT_NEAR(found.x[0], 0.08, 0.02 * 0.08);
  EXPECT_LT(found.validate, 2);
}

// A mass times its distance bends the forces: weight and inertia follow it in other ways.
TEST_F(RegressorTest, SearchesWhatIsNotLinear) {
  AddTrials({}, 1e-4);
  const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum{}.Xml()));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.3, lower: 0, upper: 1}\n"
      "  - {name: l, target: 'body:arm', attribute: 'ipos[2]', initial: -0.12, lower: -0.4, upper: "
      "-0.05}\n");
  const Problem problem(e, system);
  const Regression found = FitByRegressor(problem, problem.TrainLogs(), {.cutoff = 10});
  EXPECT_NEAR(found.x[0], 0.1, 0.002);
  EXPECT_NEAR(found.x[1], -0.2, 0.002);
  EXPECT_EQ(found.how, "l by a particle swarm, b by linear least squares inside");
}

TEST_F(RegressorTest, RefusesWhatItCannotSee) {
  AddTrials({}, 1e-4);
  const auto refused = [&](const std::string& model, const std::string& parameters) {
    const ModelSpec system = ModelSpec::Load(Write("model.xml", model));
    const Experiment e = ReadExperiment(parameters);
    const Problem problem(e, system);
    try {
      FitByRegressor(problem, problem.TrainLogs());
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string damping =
      "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1}\n";
  std::string integrated = Pendulum{}.Xml();
  integrated.replace(integrated.find("<position"), 9, "<intvelocity actrange=\"-1 1\"");
  EXPECT_THAT(refused(integrated, damping), HasSubstr("dynamics other than a first-order lag"));
  std::string bent = Pendulum{}.Xml();
  bent.insert(bent.find("<inertial pos=\"0 0 0\""), "<joint name=\"wrist\" axis=\"1 0 0\"/>");
  bent.insert(bent.find("<actuator>"),
              "<equality><joint joint1='wrist' joint2='hinge' polycoef='0 0 1 0 0'/></equality>");
  EXPECT_THAT(refused(bent, damping), HasSubstr("is not linear"));
  std::string second = Pendulum{}.Xml();
  second.insert(second.find("<inertial pos=\"0 0 0\""), "<joint name=\"wrist\" axis=\"1 0 0\"/>");
  EXPECT_THAT(refused(second, damping), HasSubstr("no output of joint 'wrist'"));
  EXPECT_THAT(refused(Pendulum{}.Xml(),
                      "parameters:\n  - {name: a, target: 'body:arm', attribute: mass, lower: 0.1, "
                      "upper: 1}\n  - {name: b, target: 'body:arm', attribute: mass, lower: 0.1, "
                      "upper: 1, operation: add, initial: 0.2}\n"),
              HasSubstr("distinguish"));
}

TEST_F(RegressorTest, ASwarmFindsThePlaceButNotThePoint) {
  CONTINUUM_LONG_IF_SANITIZED("a swarm");
  AddTrials({}, 1e-3);
  const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum{}.Xml()));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.5, lower: 0.01, upper: "
      "1}\n"
      "  - {name: kp, target: 'actuator:servo', attribute: kp, initial: 2, lower: 1, upper: 9}\n");
  const Problem problem(e, system);
  SwarmFitOptions options;
  options.swarm.iterations = 15;
  const Fit swarm = FitBySwarm(problem, problem.TrainLogs(), options);
  const Fit again = FitBySwarm(problem, problem.TrainLogs(), options);
  const Fit best = FitParameters(problem, problem.Start(), problem.TrainLogs());
  EXPECT_EQ(swarm.x, again.x);
  EXPECT_NEAR(swarm.x[1], 5, 0.3);
  EXPECT_LE(best.cost, swarm.cost * (1 + 1e-9));
  EXPECT_LT(best.evaluations * 10, swarm.evaluations);
  options.seed = 2;
  EXPECT_NE(FitBySwarm(problem, problem.TrainLogs(), options).x, swarm.x);
}

TEST_F(RegressorTest, ASwarmHasTheConstantsOfTheExperiment) {
  const auto read = [&](const std::string& swarm) {
    return ReadSwarm(Write("swarm.yaml", "format: 1\n" + swarm));
  };
  EXPECT_EQ(read("").to_own, 1.49618);
  const SwarmConstants c = read(
      "swarm: {particles: 30, iterations: 50, cost_tolerance: 0.001, spread_tolerance: 0.0001, "
      "cognitive: 3, social: 2, momentum: 0.1, constriction: 0.1146}\n");
  EXPECT_EQ(c.particles, 30);
  EXPECT_EQ(c.iterations, 50);
  EXPECT_EQ(c.cost_tolerance, 1e-3);
  EXPECT_EQ(c.spread_tolerance, 1e-4);
  EXPECT_EQ(c.to_own, 3);
  EXPECT_EQ(c.to_all, 2);
  EXPECT_EQ(c.inertia, 0.1);
  EXPECT_EQ(c.constriction, 0.1146);
  for (const std::string wrong : {"swarm: {lambda: 3}", "swarm: {cognitive: 0}",
                                  "swarm: {particles: 2.5}", "swarm: {constriction: 2}"})
    EXPECT_THROW(read(wrong), Error) << wrong;
}

}  // namespace
}  // namespace continuum
