#include "models/make.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/io/file.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

const std::string kModels = CONTINUUM_SOURCE "/models/";

struct Shipped {
  std::string description, variant, model;
};

TEST(Make, GivesTheCommittedModels) {
  for (const auto& [description, variant, model] :
       {Shipped{"annelida/annelida.yaml", "", "annelida/annelida.xml"},
        Shipped{"trunk/trunk.yaml", "", "trunk/trunk.xml"},
        Shipped{"tdcr_three_segment/tdcr_three_segment.yaml", "",
                "tdcr_three_segment/tdcr_three_segment.xml"},
        Shipped{"tdcr/tdcr.yaml", "", "tdcr/tdcr.xml"},
        Shipped{"tdcr/tdcr.yaml", "disks", "tdcr/tdcr_disks.xml"},
        Shipped{"twin_pivot/a.yaml", "", "twin_pivot/a.xml"},
        Shipped{"stiff_flop/no_load.yaml", "", "stiff_flop/stiff_flop.xml"},
        Shipped{"stiff_flop/no_load.yaml", "braid", "stiff_flop/stiff_flop_braid.xml"},
        Shipped{"spa/spa.yaml", "", "spa/spa.xml"},
        Shipped{"spa/spa.yaml", "free", "spa/spa_free.xml"},
        Shipped{"spa/spa.yaml", "series", "spa/spa_series.xml"}}) {
    EXPECT_EQ(MakeMjcf(kModels + description, variant), ReadFile(kModels + model)) << model;
  }
}

TEST(Make, RefusesOtherRobotsAndVariantsByName) {
  const testing::Scratch scratch;
  const auto worm = scratch.Write("worm.yaml", "robot: worm\n");
  EXPECT_THAT([&] { MakeMjcf(worm, ""); },
              ThrowsMessage<Error>(
                  AllOf(HasSubstr("worm.yaml:1"), HasSubstr("segments"), HasSubstr("'worm'"))));
  EXPECT_THAT([&] { MakeMjcf(kModels + "spa/spa.yaml", "disks"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("none, free, series"), HasSubstr("'disks'"))));
}

TEST(Make, LaysOutSoftActuatorsAsAsked) {
  const std::string spa = kModels + "spa/spa.yaml";
  EXPECT_EQ(MakeMjcf(spa, "", {.series = 2}), ReadFile(kModels + "spa/spa_series.xml"));
  EXPECT_THAT(MakeMjcf(spa, "", {.series = 2, .rows = 2}), HasSubstr("seg4_p3"));
  EXPECT_THAT(MakeMjcf(spa, "free", {.links = 4}), Not(HasSubstr("link5")));
  EXPECT_THAT(MakeMjcf(spa, "", {.standing = true}), Not(HasSubstr("quat=\"0 1 0 0\"")));
  EXPECT_THAT([&] { MakeMjcf(spa, "", {.series = 0}); },
              ThrowsMessage<Error>(AllOf(HasSubstr("at least one"), HasSubstr("0"))));
  EXPECT_THAT([&] { MakeMjcf(spa, "", {.links = 3}); },
              ThrowsMessage<Error>(AllOf(HasSubstr("even"), HasSubstr("3"))));
  EXPECT_THAT(
      [] { MakeMjcf(kModels + "tdcr/tdcr.yaml", "", {.rows = 2}); },
      ThrowsMessage<Error>(AllOf(HasSubstr("--rows"), HasSubstr("spa"), HasSubstr("tdcr"))));
}

}  // namespace
}  // namespace continuum
