#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/problem/problem.h"
#include "sim/numerics/parallel.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

constexpr char kFour[] = R"(parameters:
  - {name: k, target: "actuator:servo", attribute: kp, initial: 4, lower: 1, upper: 9}
  - {name: b, target: "joint:hinge", attribute: damping, initial: 0.2, lower: 0, upper: 1}
  - {name: m, target: "body:arm", attribute: mass, initial: 0.25, lower: 0.1, upper: 1}
  - {name: j, target: "joint:hinge", attribute: armature, initial: 0.002, lower: 0, upper: 1}
)";

class Linearised : public Bench {
 protected:
  // Two motions, one of them recorded twice.
  Experiment Logs(const std::string& more) {
    for (const int t : {0, 1, 1}) {
      const auto u = Command(t, 150);
      AddLog("t" + std::to_string(count_++), "trial: m" + std::to_string(t), u,
             Pendulum().Run(u, testing::kPeriod));
    }
    return ReadExperiment(kFour + more);
  }
  Problem Of(const Experiment& e, const std::string& extension = "") {
    return Problem(e, ModelSpec::Load(Write("model.xml", Pendulum().Xml(extension))));
  }

 private:
  int count_ = 0;
};

// A bias is of the measurement: its column takes no simulation, but a difference.
TEST_F(Linearised, GivesWhatResidualsAndJacobianGive) {
  const Experiment e = Logs(
      "  - {name: o, target: 'sensor:angle', attribute: bias, initial: 0.01, lower: -1, upper: "
      "1}\n");
  const Problem problem = Of(e);
  ASSERT_TRUE(problem.LinearisesCheaply());
  const auto [r, J] = problem.Linearise(problem.Start(), problem.AllLogs());
  const Problem other = Of(e);
  const auto residuals = other.Residuals(other.Start(), other.AllLogs());
  const auto jacobian = other.Jacobian(other.Start(), residuals, other.AllLogs());
  ASSERT_EQ(J.size(), 3u);
  for (std::size_t l = 0; l < J.size(); ++l) {
    EXPECT_EQ(r[l], residuals[l]) << l;
    EXPECT_EQ(J[l], jacobian[l]) << l;
    EXPECT_GT(J[l].colwise().norm().minCoeff(), 0) << l;
  }
  EXPECT_LT(problem.evaluations(), other.evaluations());
}

TEST_F(Linearised, HasNoJacobianWhereColumnsTakeDifferences) {
  const Experiment e = Logs("");
  Problem problem = Of(e);
  problem.DifferBy(1e-3);
  EXPECT_FALSE(problem.LinearisesCheaply());
  const auto [r, J] = problem.Linearise(problem.Start(), problem.AllLogs());
  EXPECT_TRUE(J.empty());
  EXPECT_EQ(r[0], problem.Residuals(problem.Start(), problem.AllLogs())[0]);
}

TEST_F(Linearised, IsNotCheapWithAnEffectOfOurs) {
  const Experiment e = Logs("");
  EXPECT_FALSE(Of(e, testing::CoulombInstance(0.01)).LinearisesCheaply());
}

// Each has its own parameters; what one remembers is no answer to another.
TEST_F(Linearised, ResidualsForSeveralThreadsAreThoseForOne) {
  const Experiment e = Logs("");
  const Problem problem = Of(e);
  constexpr std::size_t kCalls = 24;
  const auto at = [&](std::size_t i) {
    Problem::Vector x = problem.Start();
    x[0] += 0.1 * static_cast<double>(i % 5);
    return x;
  };
  std::vector<std::vector<Problem::Vector>> all(kCalls);
  ParallelFor(kCalls, [&](std::size_t, std::size_t i) {
    all[i] = problem.Residuals(at(i), problem.AllLogs());
  });
  EXPECT_EQ(problem.evaluations(), 2 * kCalls);
  for (std::size_t i = 0; i < kCalls; ++i)
    EXPECT_EQ(all[i], problem.Residuals(at(i), problem.AllLogs())) << i;
}

}  // namespace
}  // namespace continuum
