#include "identification/search_range.h"

#include <gtest/gtest.h>

#include "identification/catalog.h"

namespace continuum {
namespace {

TEST(SearchRange, ALoadMayBeFiveTimesTheWholeRobotHoweverLightItsLinks) {
  Sizes sizes;
  sizes.mass = 0.008, sizes.robot = 0.08;
  const Param& mass = EffectNamed("payload").params.front();
  const Parameter p =
      FreeOne(mass, Place::kBody, sizes, "body:tip", "mass", Change::Operation::kSet);
  EXPECT_DOUBLE_EQ(p.upper, 0.4);
  EXPECT_DOUBLE_EQ(p.initial, 0.05 * sizes.mass);
}

}  // namespace
}  // namespace continuum
