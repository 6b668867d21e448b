#include "identification/candidates/search_range.h"

#include <cmath>

#include <gtest/gtest.h>

#include "binding/effect_catalog.h"

namespace continuum {
namespace {

TEST(SearchRange, ALoadMayBeFiveTimesTheWholeRobotHoweverLightItsLinks) {
  Sizes sizes;
  sizes.mass = 0.008, sizes.robot = 0.08;
  const Param& mass = EffectNamed("payload").params.front();
  const Parameter p =
      CandidateParameter(mass, Place::kBody, sizes, "body:tip", "mass", Change::Operation::kSet);
  EXPECT_DOUBLE_EQ(p.upper, 0.4);
  EXPECT_DOUBLE_EQ(p.initial, 0.05 * sizes.mass);
}

TEST(SearchRange, WidensWhatAFitHasReachedAsFarAsTheLawAllows) {
  const std::vector<Param> law{{"k", "N*m/rad", 0, kInfinity, 0, 0}, {"share", "1", 0, 1, 0, 0}};
  std::vector<Parameter> extra(2);
  extra[0].name = "k", extra[0].upper = 2;
  extra[1].name = "share", extra[1].upper = 0.5;
  const std::vector<double> null{0, 0};
  EXPECT_FALSE(Widen(extra, null, law, std::vector<double>{1.9, 0.4}));
  EXPECT_TRUE(Widen(extra, null, law, std::vector<double>{2, 0.5}));
  EXPECT_EQ(extra[0].upper, 20);
  EXPECT_EQ(extra[1].upper, 1);  // all of it
  EXPECT_FALSE(Widen(extra, null, law, std::vector<double>{2, 1}));
}

TEST(SearchRange, AFactorStaysWithinTen) {
  const std::vector<Param> law{{"scale", "1", 0, kInfinity, 1, 1}};
  std::vector<Parameter> extra(1);
  extra[0].name = "scale", extra[0].lower = 0.1, extra[0].upper = 10;
  EXPECT_FALSE(Widen(extra, {1}, law, std::vector<double>{10}));
}

TEST(SearchRange, ALawWithAShapeOfItsOwnStaysWithinItsRange) {
  const std::vector<Param> law{{"f", "N*m", 0, kInfinity, 0, 0},
                               {"width", "rad", 0, kInfinity, 0.1, std::nan("")}};
  std::vector<Parameter> extra(2);
  extra[0].name = "f", extra[0].upper = 2;
  extra[1].name = "width", extra[1].upper = 3;
  EXPECT_FALSE(Widen(extra, {0, std::nan("")}, law, std::vector<double>{2, 3}));
  EXPECT_EQ(extra[0].upper, 2);
}

}  // namespace
}  // namespace continuum
