#include <gtest/gtest.h>

#include "identification/problem/problem.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

class StepOf : public testing::Bench {
 protected:
  // Of a parameter at 0.1, over a share of its size.
  double At(const std::string& bounds, double share) {
    if (logs_.empty()) AddLog("t0", "trial: t0, use: train", {0, 0}, {0, 0});
    const Experiment e = ReadExperiment(
        "parameters: [{name: b, target: 'joint:hinge', attribute: damping, initial: 0.1, " +
        bounds + "}]\n");
    const Problem problem(e, ModelSpec::Load(Write("model.xml", testing::Pendulum().Xml())));
    return problem.StepOf(problem.Start(), 0, share);
  }
};

TEST_F(StepOf, GoesUpWhereThereIsRoomElseDown) {
  const double up = At("lower: 0, upper: 1", 0.2);
  EXPECT_GT(up, 0);
  EXPECT_LT(At("lower: 0, upper: 0.1", 0.2), 0);
}

// Beyond its bounds an inertia is none that a body can have.
TEST_F(StepOf, EndsAtTheFartherOfTwoBoundsThatAreNear) {
  EXPECT_NEAR(At("lower: 0.099, upper: 0.102", 0.9), 0.002, 1e-12);
  EXPECT_NEAR(At("lower: 0.098, upper: 0.101", 0.9), -0.002, 1e-12);
}

TEST_F(StepOf, IsAShareOfTheStartWhereABoundIsNone) {
  EXPECT_NEAR(At("lower: 0, upper: 1e12", 0.2), 0.02, 1e-12);
  EXPECT_NEAR(At("lower: -1e12, upper: 1e12", 0.2), 0.02, 1e-12);
}

}  // namespace
}  // namespace continuum
