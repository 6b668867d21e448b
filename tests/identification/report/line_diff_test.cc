#include "identification/report/line_diff.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::IsEmpty;

TEST(LineDiff, ShowsWhatWentAndWhatCame) {
  EXPECT_THAT(LineDiff("a\nb\nc\n", "a\nb\nc\n"), IsEmpty());
  EXPECT_EQ(LineDiff("a\nb\nc\n", "a\nx\nc\n"), "-b\n+x\n");
  EXPECT_EQ(LineDiff("a\nc\n", "a\nb\nc\nd\n"), "+b\n+d\n");
  EXPECT_EQ(LineDiff("a\nb\nc\n", "c\n"), "-a\n-b\n");
  EXPECT_EQ(LineDiff("", "a\n"), "+a\n");
}

// b, c and d stay in their order: four lines are shown, not ten.
TEST(LineDiff, IsMinimal) {
  const std::string diff = LineDiff("a\nb\nc\nd\ne\n", "b\nx\nc\nd\na\n");
  EXPECT_EQ(std::count(diff.begin(), diff.end(), '\n'), 4);
}

}  // namespace
}  // namespace continuum
