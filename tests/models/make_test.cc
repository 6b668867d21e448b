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

}  // namespace
}  // namespace continuum
