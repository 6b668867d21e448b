#include "sim/io/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::size_t kWide = 200;

TEST(ProgressText, SaysWhatIsDoneWhatIsLeftAndHowLongThatTakes) {
  ProgressText text;
  text.Line({"screen", 0, 40, "payload", 2, 10}, 100, kWide);
  const std::string line = text.Line({"screen", 10, 40, "dahl", 2, 10}, 105, kWide);
  EXPECT_THAT(line, AllOf(StartsWith("2/10 screen, 10 of 40"), HasSubstr("about 15 s more"),
                          HasSubstr("dahl")));
}

TEST(ProgressText, TimesTheStepsOfAStageAlone) {
  ProgressText text;
  text.Line({"screen", 0, 10}, 0, kWide);
  text.Line({"screen", 9, 10}, 900, kWide);
  EXPECT_THAT(text.Line({"fits", 0, 4}, 1000, kWide), Not(HasSubstr("about")));
  EXPECT_THAT(text.Line({"fits", 2, 4}, 1004, kWide), HasSubstr("about 4 s more"));
  // The same stage again, with other steps.
  EXPECT_THAT(text.Line({"fits", 0, 8}, 1010, kWide), Not(HasSubstr("about")));
}

TEST(ProgressText, SaysNothingOfTheTimeWhereNobodyKnowsTheSteps) {
  ProgressText text;
  text.Line({"fit", 1}, 0, kWide);
  const std::string line = text.Line({"fit", 7}, 60, kWide);
  EXPECT_THAT(line, AllOf(HasSubstr("7 done"), Not(HasSubstr("about"))));
}

TEST(ProgressText, FitsALineOfTheTerminalInWholeCharacters) {
  ProgressText text;
  const Progress progress{"fit", 0, 0, "käse"};
  EXPECT_EQ(text.Line(progress, 0, 6), "fit: k");
  EXPECT_EQ(text.Line(progress, 0, 7), "fit: k");  // half of its second letter
  EXPECT_EQ(text.Line(progress, 0, 8), "fit: k\xC3\xA4");
}

TEST(ProgressText, BeginsAStageOnce) {
  ProgressText text;
  EXPECT_EQ(text.Beginning({"screen", 0, 74, "payload"}), "screen (74 steps)");
  EXPECT_EQ(text.Beginning({"screen", 1, 74, "dahl"}), "");
  EXPECT_EQ(text.Beginning({"fits"}), "fits");
  EXPECT_EQ(text.Beginning({"screen", 0, 3}), "");
}

TEST(ProgressWithin, StandsForTheLongerStage) {
  Progress last;
  const auto inner = Within({"second cause", 1, 4, "beside dahl", 5, 10},
                            [&](const Progress& progress) { last = progress; });
  inner({"screen", 3, 74, "payload", 2, 10});
  EXPECT_EQ(last.stage, "second cause");
  EXPECT_EQ(last.number, 5u);
  EXPECT_EQ(last.done, 1u);
  EXPECT_EQ(last.at, "beside dahl, screen, 3 of 74: payload");
  EXPECT_FALSE(Within({"second cause"}, {}));
}

}  // namespace
}  // namespace continuum
