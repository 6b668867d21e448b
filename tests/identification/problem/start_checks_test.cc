#include "identification/problem/start_checks.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::HasSubstr;
using testing::Pendulum;

class Effect : public Bench {
 protected:
  // A delay that begins at some share of the time step.
  Experiment Delay(double steps) {
    const auto u = Command(0, 150);
    AddLog("t0", "trial: m0", u, Pendulum().Run(u, testing::kPeriod));
    return ReadExperiment(
        "parameters:\n  - {name: T, target: 'actuator:servo', attribute: delay, initial: " +
        std::to_string(steps * testing::kPeriod) + ", lower: 0, upper: 0.5}\n");
  }
  // Without an effect at x.
  std::string Told(const Experiment& e, const Problem::Vector& x) {
    const Problem problem(e, ModelSpec::Load(Write("model.xml", Pendulum().Xml(""))));
    try {
      RequireEffect(problem, x, {Problem::Matrix::Zero(150, 1)});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Effect, IsRequiredWhereAFitBegins) {
  const Experiment e = Delay(3);
  EXPECT_THAT(Told(e, Problem::Vector::Constant(1, 3 * testing::kPeriod)),
              HasSubstr("expected an effect on some output at its start"));
}

TEST_F(Effect, IsNotRequiredWhereAFitHasMovedIt) {
  const Experiment e = Delay(3);
  EXPECT_EQ(Told(e, Problem::Vector::Constant(1, 0.1 * testing::kPeriod)), "");
}

}  // namespace
}  // namespace continuum
