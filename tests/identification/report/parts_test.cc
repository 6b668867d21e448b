#include "identification/report/parts.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Parts, ThatThrowLeaveABadgeAndNothingOfWhatTheyHadAdded) {
  Page page("Fit");
  std::vector<MissingPart> missing;
  page.Paragraph("before");
  AddPart(page, "half", missing, [&] {
    page.Heading("Half");
    page.Details("open", [&] {
      page.Scatter({"broken", {"x", ""}, {"y", ""}, {{"g", {1, 2}, {1}}}});
    });
  });
  AddPart(page, "whole", missing, [&] { page.Paragraph("after"); });
  const std::string html = page.Html();
  EXPECT_THAT(html, HasSubstr("before"));
  EXPECT_THAT(html, HasSubstr("Not in this report: half"));
  EXPECT_THAT(html, HasSubstr("after"));
  EXPECT_THAT(html, Not(HasSubstr("Half")));
  EXPECT_THAT(html, Not(HasSubstr("<summary>open")));
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_THAT(missing[0].why, HasSubstr("broken"));
}

TEST(Parts, ThatAreMissingAreListedOnceEach) {
  const std::vector<MissingPart> missing{
      {"error", "no rows"}, {"ahead", "no"}, {"error", "no rows"}};
  EXPECT_EQ(MissingInWords(missing),
            "not in the report: error: no rows\nnot in the report: ahead: no\n");
  EXPECT_EQ(MissingInWords({}), "");
  nlohmann::json json;
  AddMissing(json, {});
  EXPECT_TRUE(json.is_null());
}

TEST(Parts, ThatThrowWhateverTheyLikeCostOnlyThemselves) {
  std::vector<MissingPart> missing;
  EXPECT_FALSE(MakePart("a", missing, [] { throw std::logic_error("index 3 of 2"); }));
  EXPECT_TRUE(MakePart("b", missing, [] {}));
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0].InWords(), "a: index 3 of 2");
}

}  // namespace
}  // namespace continuum
