// Sensitivities of whole logs with effects, in closed form, against narrow differences.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/problem/problem.h"
#include "random_laws.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using testing::RandomLaw;
using testing::RandomNumbers;

class EffectLogsTest : public testing::Bench, public ::testing::WithParamInterface<RandomLaw> {
 protected:
  Experiment Read(const RandomLaw& law) const {
    RandomNumbers number(3, 0);
    Write("model.xml", testing::RandomArm(law, number, "implicitfast"));
    std::string csv = "time,pull,swing,turn,wind,p1,p2,p3,x0,y2,x1,ex,ez,u,v,s\n";
    for (int k = 0; k < 60; ++k) {
      const double t = 0.0105 * k;
      csv +=
          fmt::format("{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{:.1f},{:.1f},2e4,0,0,0,0,0,0,0,0\n", t,
                      k < 35   ? 5.0
                      : k < 37 ? -3.0
                               : 2.0,
                      0.9 * std::sin(7 * t), 0.8 * std::sin(5 * t), -0.2 + 0.1 * std::sin(4 * t),
                      2e4 * (1 + std::sin(9 * t)), 3e4 * t);
    }
    Write("log.csv", csv);
    std::string parameters =
        "parameters:\n"
        "  - {name: m, target: 'body:link1', attribute: mass, initial: 0.1, lower: 0.01, upper: "
        "1}\n"
        "  - {name: k, target: 'joint:y2', attribute: stiffness, initial: 0.5, lower: 0, upper: "
        "9}\n"
        "  - {name: j, target: 'joint:y1', attribute: armature, initial: 1e-4, lower: 0, upper: "
        "1}\n"
        "  - {name: kp, target: 'actuator:servo', attribute: kp, initial: 0.8, lower: 0, upper: "
        "9}\n"
        "  - {name: link, target: 'body:link1', attribute: 'pos[2]', initial: -0.1, lower: -0.2, "
        "upper: 0}\n"
        "  - {name: hole, target: 'site:a0', attribute: 'pos[0]', initial: 0.03, lower: 0, upper: "
        "0.1}\n";
    for (const auto& [key, range] : law.parameters) {
      const double middle = 0.4 * range.first + 0.6 * range.second, nothing = middle == 0;
      parameters += fmt::format(
          "  - {{name: {0}, target: 'plugin:law', attribute: {0}, initial: {1}, lower: {2}, upper: "
          "{3}}}\n",
          key, middle, middle - 0.1 * std::abs(middle), middle + 0.2 * std::abs(middle) + nothing);
    }
    return Experiment::Read(
        Write("e.yaml",
              "format: 1\nmodel: model.xml\ntime: {column: time, unit: s}\nstart: rest\ninputs:\n"
              "  - {column: pull, unit: N, actuator: pull}\n"
              "  - {column: swing, unit: N, actuator: lagged}\n"
              "  - {column: turn, unit: rad, actuator: servo, interpolate: linear}\n"
              "  - {column: wind, unit: m, actuator: winch}\n"
              "  - {column: p1, unit: Pa, actuator: p1}\n"
              "  - {column: p2, unit: Pa, actuator: p2}\n"
              "  - {column: p3, unit: Pa, actuator: p3}\n"
              "outputs:\n"
              "  - {column: x0, unit: rad, sensor: x0, sigma: 1}\n"
              "  - {column: y2, unit: rad/s, sensor: y2, sigma: 1}\n"
              "  - {column: x1, unit: rad, sensor: x1, sigma: 1}\n"
              "  - {column: ex, unit: m, sensor: 'end[0]', sigma: 1}\n"
              "  - {column: ez, unit: m, sensor: 'end[2]', sigma: 1}\n"
              "  - {column: u, unit: rad, sensor: u, sigma: 1}\n"
              "  - {column: v, unit: rad, sensor: v, sigma: 1}\n"
              "  - {column: s, unit: m, sensor: s, sigma: 1}\n"
              "logs:\n  - {file: log.csv, use: train}\n" +
                  parameters));
  }
};

// Differences over a share of the parameters' scales; at a bound one-sided to second order.
Problem::Matrix Narrow(const Experiment& e, const ModelSpec& system, double share) {
  Problem differences(e, system);
  differences.Center();
  const auto use = differences.AllLogs();
  const auto x = differences.Start();
  const auto r = differences.Residuals(x, use);
  const auto over = [&](double reach) {
    differences.DifferBy(reach);
    return differences.Jacobian(x, r, use)[0];
  };
  Problem::Matrix slopes = over(share);
  const Problem::Matrix wide = over(2 * share);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (x[k] == differences.parameters()[k].lower) slopes.col(k) += slopes.col(k) - wide.col(k);
  }
  return slopes;
}

TEST_P(EffectLogsTest, HaveTheSensitivitiesOfNarrowDifferences) {
  constexpr double kShare = 1e-6;
  const Experiment e = Read(GetParam());
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  ASSERT_EQ(problem.NoClosedForm(), "");
  const auto use = problem.AllLogs();
  const auto x = problem.Start();
  const auto r = problem.Residuals(x, use);
  const std::size_t before = problem.evaluations();
  const auto found = problem.Jacobian(x, r, use)[0];
  EXPECT_EQ(problem.evaluations() - before, 1u);
  const auto expected = Narrow(e, system, kShare);
  for (Eigen::Index k = 0; k < expected.cols(); ++k) {
    const double size = expected.col(k).cwiseAbs().maxCoeff();
    const double step = std::abs(problem.StepOf(x, static_cast<std::size_t>(k), kShare));
    const double rounding = 1e-13 / step;  // of the differences
    EXPECT_GT(size, rounding) << problem.parameters()[k].name;
    EXPECT_LT((found.col(k) - expected.col(k)).cwiseAbs().maxCoeff(), 1e-5 * size + rounding)
        << problem.parameters()[k].name;
  }
}

// A cable that remembers over the rows without tension, and forgets some of it.
INSTANTIATE_TEST_SUITE_P(Slack, EffectLogsTest,
                         ::testing::Values(RandomLaw{
                             "CapstanThatForgets",
                             "capstan",
                             "<config key='tendon' value='ta'/>",
                             {{"mu", {0.05, 0.4}}, {"give", {0.05, 0.1}}}}));

class NoFrictionTest : public EffectLogsTest {};

TEST_P(NoFrictionTest, LeavesCablesToDifferences) {
  const Experiment e = Read(GetParam());
  const ModelSpec system = ModelSpec::Load(e.model);
  EXPECT_THAT(Problem(e, system).NoClosedForm(), HasSubstr("without friction"));
}

INSTANTIATE_TEST_SUITE_P(
    Capstan, NoFrictionTest,
    ::testing::Values(RandomLaw{
        "Capstan", "capstan", "<config key='tendon' value='ta'/>", {{"mu", {0, 0}}}}));
INSTANTIATE_TEST_SUITE_P(Law, EffectLogsTest, ::testing::ValuesIn(testing::RandomLaws()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Nothing, EffectLogsTest, ::testing::ValuesIn(testing::LawsThatDoNothing()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace continuum
