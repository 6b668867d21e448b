#include "identification/fit/local_search.h"

#include <string>

#include <gtest/gtest.h>

#include "support/wheel.h"

namespace continuum {
namespace {

// Turned to and fro by steps of torque, and held again by friction.
constexpr char kModel[] = R"(<mujoco>
  <option timestep="2e-3" integrator="implicitfast"/>
  <worldbody><body><joint name="hinge" stiffness="40" damping="1" armature="0.8" FRICTION/>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
  <actuator><motor name="servo" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)";

std::string Model(const std::string& friction) {
  std::string xml = kModel;
  return xml.replace(xml.find("FRICTION"), 8, friction);
}

class LocalSearch : public testing::Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    const std::vector<double> u = testing::ToAndFro();
    AddLog("shaken", "use: train", u,
           testing::Noisy(testing::Wheel{1.2, 60, 1.5, 2}.Run(u), 1e-4, 0, 1));
    experiment_ = ReadExperiment(
        "parameters:\n"
        "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 50, lower: 1, "
        "upper: 300}\n"
        "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 1.6, lower: 0.01, "
        "upper: 20}\n"
        "  - {name: j, target: 'joint:hinge', attribute: armature, initial: 2, lower: 0.1, "
        "upper: 10}\n"
        "  - {name: fc, target: 'joint:hinge', attribute: frictionloss, initial: 1, lower: 0, "
        "upper: 6}\n");
  }
  Fit Here(const Problem& problem) const {
    Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs(), {.iterations = 1});
    return fit;
  }
  Experiment experiment_;
};

class RepeatedWheel : public testing::Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    const std::vector<double> u = testing::ToAndFro(),
                              angle = testing::Wheel{0.82, 60, 1.5, 0.1}.Run(u);
    for (const int seed : {2, 3})
      AddLog("repeated" + std::to_string(seed), "trial: one, use: train", u,
             testing::Noisy(angle, 5e-4, 0, seed));
  }
};

TEST_F(LocalSearch, FindsALowerMinimumOfAMachineThatSticksAndRepeats) {
  const Problem problem(experiment_,
                        ModelSpec::Load(Write("model.xml", Model("frictionloss=\"1.2\""))));
  const Fit before = Here(problem);
  Fit one = before, other = before;
  const LocalMinima minima =
      SearchAround(problem, problem.Start(), problem.TrainLogs(), 5, {}, one);
  SearchAround(problem, problem.Start(), problem.TrainLogs(), 5, {}, other);
  EXPECT_LT(one.cost, 0.9 * before.cost);
  EXPECT_NEAR(one.x[0], 60, 2);
  EXPECT_EQ(one.x, other.x);
  EXPECT_GE(minima.found.size(), 2u);
  for (const LocalMinimum& m : minima.found) EXPECT_GE(m.cost, one.cost);
  EXPECT_GT(one.evaluations, before.evaluations);
  EXPECT_EQ(one.trace.size(), static_cast<std::size_t>(one.iterations) + 1);
  EXPECT_EQ(one.trace.back(), one.cost);
}

TEST_F(LocalSearch, HasNothingToLookForWhereNothingRubs) {
  const Problem problem(experiment_, ModelSpec::Load(Write("model.xml", Model(""))));
  Fit fit = Here(problem);
  const std::size_t before = fit.evaluations;
  EXPECT_TRUE(
      SearchAround(problem, problem.Start(), problem.TrainLogs(), 5, {}, fit).found.empty());
  EXPECT_EQ(fit.evaluations, before);
}

// Repetitions tell the noise; slopes predict what small steps do, and yet more is left.
TEST_F(RepeatedWheel, IsLookedAtFromItsStartAsMoreThanNoiseIsLeft) {
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 50, lower: 1, "
      "upper: 300}\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 1.6, lower: 0.01, "
      "upper: 20}\n");
  const Problem problem(e, ModelSpec::Load(Write("model.xml", Model("frictionloss=\"0.1\""))));
  const std::vector<bool> use = problem.TrainLogs();
  const Fit there = FitParameters(problem, problem.Start(), use);
  ASSERT_TRUE(IsMoreThanNoise(problem, there.x, problem.Residuals(there.x, use), use));
  Fit with = there, without = there;
  EXPECT_FALSE(SearchAround(problem, problem.Start(), use, 5, {}, with).found.empty());
  EXPECT_TRUE(SearchAround(problem, {}, use, 5, {}, without).found.empty());
}

// What a minimum elsewhere says against a fit at 2 with a cost of 100 and the interval 1.8 … 2.2.
std::string Said(double value, double cost) {
  const auto all = [](double one) { return Eigen::VectorXd::Constant(1, one); };
  Uncertainty u;
  u.lower = all(1.8), u.upper = all(2.2);
  FreeParameter k;
  k.name = "k";
  return LocalMinima{{{all(value), cost}}}.Doubts(all(2), 100, u, {k});
}

TEST(LocalMinima, OutsideOfAnIntervalMakeItDoubtful) {
  const std::string said = Said(2.5, 100.9);
  EXPECT_NE(said.find("several minima: k 2 … 2.5"), said.npos) << said;
  EXPECT_NE(said.find("not to be trusted"), said.npos) << said;
}

TEST(LocalMinima, ThatFitWorseOrLieWithinSayNothing) {
  EXPECT_EQ(Said(2.5, 101.1), "");
  EXPECT_EQ(Said(2.1, 100.1), "");
}

}  // namespace
}  // namespace continuum
