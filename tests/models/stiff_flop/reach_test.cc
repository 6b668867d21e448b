#include "models/stiff_flop/reach.h"

#include <gtest/gtest.h>

#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/published.h"

namespace continuum::stiff_flop {
namespace {

// Three pressures and three coordinates: the pressures of a tip are found again.
TEST(StiffFlopReach, FindsThePressuresOfATip) {
  const Module module = Published();
  const Method method = Method::Parse("hooke+general+constant", Direction::kForward);
  Case row{"", Eigen::Vector3d(40e3, 15e3, 0), {{0.02, 0.01, 0}, {0, 9.81, 0}}};
  const Solution s = SolveForward(module, method, row, false);
  ASSERT_EQ(s.status, Status::kOk);
  const Eigen::Vector3d made = row.given;
  row.given.setZero();
  const auto reached = Reach(module, method, row, {"", {0, 1, 2}, s.tip});
  ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
  EXPECT_LT(reached.miss, 1e-7 * module.l);
  EXPECT_LT((reached.drives - made).norm(), 100);  // of 1e-6 l at most
}

}  // namespace
}  // namespace continuum::stiff_flop
