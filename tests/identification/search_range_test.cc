#include "identification/search_range.h"

#include <cmath>

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

TEST(SearchRange, WidensWhatAFitHasReachedAsFarAsTheLawAllows) {
  const std::vector<Param> law{{"k", "N*m/rad", 0, kInfinity, 0, 0},
                               {"share", "1", 0, 1, 0, 0},
                               {"width", "rad", 0, kInfinity, std::nan(""), 0}};
  std::vector<Parameter> extra(3);
  extra[0].name = "k", extra[0].upper = 2;
  extra[1].name = "share", extra[1].upper = 0.5;
  extra[2].name = "width", extra[2].upper = 3;
  const std::vector<double> null{0, 0, std::nan("")};
  EXPECT_FALSE(Widen(extra, null, law, std::vector<double>{1.9, 0.4, 3}));
  EXPECT_TRUE(Widen(extra, null, law, std::vector<double>{2, 0.5, 3}));
  EXPECT_EQ(extra[0].upper, 20);
  EXPECT_EQ(extra[1].upper, 1);  // all of it
  EXPECT_EQ(extra[2].upper, 3);  // no amplitude
  EXPECT_FALSE(Widen(extra, null, law, std::vector<double>{2, 1, 3}));
}

}  // namespace
}  // namespace continuum
