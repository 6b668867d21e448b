#include "models/make.h"

#include <string>

#include <fmt/format.h>
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
        Shipped{"annelida/annelida.yaml", "pipe", "annelida/annelida_pipe.xml"},
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

// Robots that `continuum solve` takes: without weight, and as small as a catheter's tip.
TEST(Make, TakesRobotsThatWeighNothingOrNextToNothing) {
  const std::string pivots =
      "format: 1\nrobot: twin_pivot\ndiscs: [2]\nL: 6.0e-3\nh: 6.0e-3\nE: 60.0e9\nI_z: 2.0e-14\n"
      "rods: 2\nr: [5.0e-3, 5.0e-3, 5.0e-3]\nphi: [0, 2.1, 4.2]\ncables: [3]\nm_D: 0\n"
      "m_NiTi: 0\nrho_cable: 0\nm_CL: 0\ngravity: [0, 0, 0]\n"
      "friction: {a: 16.7, b: 0, c: 0.14, mu_const: 0.3, eps: 1.0e-6}\n";
  const auto rod = [](const char* sizes, const char* radius) {
    return fmt::format(
        "format: 1\nrobot: tdcr\nmu: 0.1\ngravity: 0\nsections: [{{E: 60.0e9, nu: 0.3, disks: 5, "
        "{}}}]\ntendons: [{{radius: {}, angle: 0}}]\n",
        sizes, radius);
  };
  const testing::Scratch scratch;
  for (const std::string& robot :
       {pivots, rod("length: 0.1, diameter: 1.0e-3, density: 0", "5.0e-3"),
        rod("length: 0.1, diameter: 1.0e-3, density: 0, disk_mass: 1.0e-3", "5.0e-3"),
        rod("length: 0.01, diameter: 1.0e-4, density: 6450", "0.5e-3")}) {
    EXPECT_THAT(MakeMjcf(scratch.Write("robot.yaml", robot), ""), HasSubstr("cable1")) << robot;
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
