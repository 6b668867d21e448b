#include "sim/check/finding_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/check/check.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Severity = Finding::Severity;

Finding Warning(const std::string& log, const std::string& channel, const std::string& summary,
                const std::string& places = "") {
  return {log, channel, "jump", summary + places, summary, 0.5, 0.5, Severity::kWarning};
}

TEST(FindingGroups, TellOneThingOnceWithTheRangesOfItsNumbers) {
  const std::vector<Finding> all{
      Warning("a", "q1", "jumps in 4 of 100 rows, most by -0.2 m", ", 0.1 m in row 4"),
      Warning("a", "q2", "jumps in 12 of 100 rows, most by 1e-3 m"),
      Warning("b", "q2", "jumps in 1 of 90 rows, most by 0.3 m")};
  const auto groups = Grouped(all);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].text, "jumps in 1..12 of 90..100 rows, most by -0.2..0.3 m");
  EXPECT_THAT(groups[0].channels, ElementsAre("q1", "q2"));
  EXPECT_THAT(groups[0].logs, ElementsAre("a", "b"));
  EXPECT_THAT(groups[0].members, ElementsAre(&all[0], &all[1], &all[2]));
}

TEST(FindingGroups, KeepsApartWhatOtherWordsOrUnitsSay) {
  const auto groups =
      Grouped({Warning("a", "q1", "most by 0.2 m"), Warning("a", "q2", "most by 0.2 mm"),
               Warning("b", "q1", "copies q2"), Warning("b", "q3", "copies q4"),
               Warning("b", "q4", "0.2 N/m^2"), Warning("b", "q5", "0.2 N/m^3")});
  EXPECT_EQ(groups.size(), 6u);
}

TEST(FindingGroups, OfOneKeepTheirWholeText) {
  const auto groups = Grouped({Warning("a", "q1", "jumps by 0.2 m", ", 0.1 m in row 4")});
  EXPECT_EQ(groups[0].text, "jumps by 0.2 m, 0.1 m in row 4");
}

TEST(CheckReport, SaysWhatLogsHaveInCommonOnceAndAllOnRequest) {
  std::vector<Finding> all;
  for (const char* log : {"a", "b", "c", "d"}) {
    for (const char* channel : {"q1", "q2"}) all.push_back(Warning(log, channel, "jumps in 1 row"));
  }
  all.push_back(Warning("d", "q3", "lags by 3 rows"));
  for (const char* channel : {"q1", "q2", "q3"})
    all.push_back(Warning(channel == std::string("q1") ? "a" : "b", channel, "is constant"));
  const std::string text = Report(all);
  EXPECT_THAT(text, ::testing::StartsWith("0 errors, 3 warnings, 0 notes\nseveral logs\n"));
  EXPECT_THAT(text, HasSubstr("q1, q2 in all 4 logs: jumps in 1 row; first in a at t = 0.5 s\n"));
  EXPECT_THAT(text, HasSubstr("q1, q2, q3, 3 times in a, b: is constant; first in a"));
  EXPECT_THAT(text, HasSubstr("log d\n  warning jump             q3: lags by 3 rows\n"));
  EXPECT_THAT(text, HasSubstr("12 findings in all: --all lists them"));
  const std::string full = FullReport(all);
  EXPECT_THAT(full, ::testing::StartsWith("0 errors, 12 warnings, 0 notes\nlog a\n"));
  EXPECT_THAT(full, HasSubstr("log c\n  warning jump             q1: jumps in 1 row\n"));
}

// As the lags of the twelve joints of a quadruped.
TEST(CheckReport, MakesOneLineOfManyFindingsOfOneKind) {
  std::vector<Finding> all;
  for (int k = 1; k <= 12; ++k) {
    const std::string number = std::to_string(k);
    Finding f = Warning("a", "q" + number, "follows input 'u" + number + "'");
    f.what = "lag";
    all.push_back(f);
  }
  for (int k = 1; k <= 3; ++k) all.push_back(Warning("a", "q1", std::string(k, 'x')));
  const std::string text = Report(all);
  EXPECT_THAT(text, ::testing::StartsWith("0 errors, 4 warnings, 0 notes\n"));
  EXPECT_THAT(text,
              HasSubstr("q1: follows input 'u1' (11 more of this kind: q10; q11; q12; q2; q3; "
                        "q4; q5; q6; and 3 more)\n"));
  EXPECT_THAT(text, HasSubstr("15 findings in all: --all lists them"));
  EXPECT_THAT(FullReport(all), HasSubstr("q7: follows input 'u7'\n"));
}

}  // namespace
}  // namespace continuum
