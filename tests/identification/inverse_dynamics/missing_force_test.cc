#include "identification/inverse_dynamics/missing_force.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Pendulum;

// A pendulum with a joint across the plane in which it swings, which nothing measures.
class JointAcross : public Bench {
 protected:
  MissingForce Found(const std::string& more) {
    Pendulum truth;
    truth.damping = 0.2;
    const auto u = Command(0, 100);
    AddLog("a", "use: train", u, truth.Run(u, testing::kPeriod));
    std::string xml = Pendulum().Xml();
    const std::string before = "<joint name=\"hinge\"";
    xml.insert(xml.find(before),
               "<joint name=\"across\" axis=\"1 0 0\" damping=\"0.1\"" + more + "/>");
    const Experiment e = ReadExperiment("");
    const Problem problem(e, ModelSpec::Load(Write("model.xml", xml)));
    return FindMissingForce(problem, problem.Start());
  }
};

// The damping that the model lacks, 0.1 N m s/rad: half of it within the accuracy of the quartic.
TEST_F(JointAcross, CountsAsAtRestWhereNothingMovesIt) {
  const MissingForce f = Found("");
  ASSERT_EQ(f.joint, "hinge");
  EXPECT_THAT(f.at_rest, ElementsAre("across"));
  double product = 0, squares = 0;
  for (std::size_t k = 0; k < f.force.size(); ++k)
    product += f.force[k] * f.velocity[k], squares += f.velocity[k] * f.velocity[k];
  EXPECT_NEAR(product / squares, -0.1, 0.01);
}

TEST_F(JointAcross, LeavesTheForceUnknownWhereTheModelMovesIt) {
  const MissingForce f = Found(" stiffness=\"5\" springref=\"20\"");
  EXPECT_EQ(f.joint, "");
  EXPECT_THAT(f.force, IsEmpty());
}

}  // namespace
}  // namespace continuum
