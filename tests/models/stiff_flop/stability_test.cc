#include <gtest/gtest.h>

#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/published.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;
using statics::Branch;

Solution Pushed(const char* method, const Vector3d& force) {
  const Case row{"", Vector3d::Zero(), {force, {0, 9.81, 0}}};
  return SolveForward(Published(), Method::Parse(method, Direction::kForward), row, false);
}

// All three roots of a planar rod by an independent integration; the one on the path from no load.
TEST(StiffFlopStability, APushBucklesTheModuleToTheSideOfItsHint) {
  const Solution aside = Pushed("hooke+fixed+fixed", {0.05, -1.5, 0});
  ASSERT_EQ(aside.status, Status::kOk);
  EXPECT_LT((aside.tip - Vector3d(0.03019, 0.02473, 0)).norm(), 2e-4);
  const Solution hint = Pushed("hooke+fixed+fixed", {0.001, -1.5, 0});
  ASSERT_EQ(hint.status, Status::kOk);
  EXPECT_LT((hint.tip - Vector3d(0.02965, 0.02547, 0)).norm(), 2e-4);
  EXPECT_EQ(hint.stability.branch, Branch::kRising);
  EXPECT_EQ(hint.stability.unstable_directions, 0);
}

TEST(StiffFlopStability, WithTheDeformedSectionToo) {
  const Solution aside = Pushed("hooke+general+constant", {0.05, -1.5, 0});
  ASSERT_EQ(aside.status, Status::kOk);
  EXPECT_GT(aside.tip.x(), 0.015);
}

TEST(StiffFlopStability, AnAxialPushBendsItToOneSideAndSaysSo) {
  const Solution s = Pushed("hooke+fixed+fixed", {0, -1.5, 0});
  ASSERT_EQ(s.status, Status::kOk) << s.outcome.why;
  EXPECT_EQ(s.stability.branch, Branch::kSymmetric);
  EXPECT_GT(std::hypot(s.tip.x(), s.tip.z()), 0.02);
}

TEST(StiffFlopStability, APushThatFoldsTheSectionIsOutOfTheDomain) {
  const Solution s = Pushed("hooke+fixed+fixed", {0.1, -2.9, 0});
  EXPECT_EQ(s.status, Status::kOutOfDomain);
  EXPECT_NE(s.outcome.why, "");
}

}  // namespace
}  // namespace continuum::stiff_flop
