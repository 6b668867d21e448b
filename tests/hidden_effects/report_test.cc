#include "hidden_effects/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hidden_effects/pictures.h"

namespace continuum::hidden {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Outcome Of(std::vector<std::string> effects, const std::string& verdict,
           std::vector<std::string> named, bool right) {
  Outcome o;
  o.noise = "white", o.effects = std::move(effects), o.verdict = verdict;
  o.named = std::move(named), o.right = right, o.unique = verdict == "named";
  return o;
}

// A payload found, of size 2 in 1 to 2.5 around 1.8; a lag in a set; the name of another force; and
// four more.
std::vector<Outcome> Some() {
  Outcome found = Of({"payload"}, "named", {"payload"}, true);
  found.truth = 2, found.value = 1.8, found.low = 1, found.high = 2.5;
  found.stated = {{"payload", 0.99}, {"armature", 0.01}};
  Outcome set = Of({"pt1"}, "ambiguous", {"sensor_delay", "pt1"}, true);
  set.factor = 4, set.stated = {{"pt1", 0.4}, {"sensor_delay", 0.6}};
  Outcome two = Of({"payload", "coulomb"}, "named", {"payload"}, true);
  two.partner = {"coulomb"};
  Outcome unlisted = Of({"payload"}, "unexplained", {}, false);
  unlisted.listed = false;
  return {found,
          set,
          two,
          unlisted,
          Of({"coulomb"}, "named", {"maxwell"}, false),
          Of({}, "adequate", {}, false),
          Of({"coulomb"}, "adequate", {}, false)};
}

int At(const Matrix& m, const std::string& row, const std::string& column) {
  const auto place = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  return m.count.at(place(m.rows, row)).at(place(m.columns, column));
}

TEST(Tally, EveryCaseStandsOnceInEitherMatrix) {
  for (const Matrix& m : {Confusion(Some()), Worth(Some())}) {
    int sum = 0;
    for (const auto& row : m.count) {
      for (const int n : row) sum += n;
    }
    EXPECT_EQ(sum, 7) << m.title;
  }
}

TEST(Tally, TheConfusionIsBetweenGroups) {
  const Matrix m = Confusion(Some());
  EXPECT_EQ(At(m, "mass", "mass"), 1);
  EXPECT_EQ(At(m, "lateness", "lateness"), 1);
  EXPECT_EQ(At(m, "dry friction", "force"), 1);
  EXPECT_EQ(At(m, "dry friction", "adequate"), 1);
  EXPECT_EQ(At(m, "two effects", "two effects"), 1);
  EXPECT_EQ(At(m, "nothing", "adequate"), 1);
  EXPECT_EQ(At(m, "mass, not listed", "unexplained"), 1);
}

TEST(Tally, TheWorthOfAnAnswerIsNameOrSetAndRightOrWrong) {
  const Matrix m = Worth(Some());
  EXPECT_EQ(At(m, "mass", "named, right"), 1);
  EXPECT_EQ(At(m, "lateness", "set, right"), 1);
  EXPECT_EQ(At(m, "dry friction", "named, wrong"), 1);
  EXPECT_EQ(At(m, "two effects", "named, right"), 1);
}

TEST(Tally, PowerCountsOneListedEffectBySize) {
  const auto curves = PowerOf(Some());
  ASSERT_EQ(curves.back().group, "all");
  const auto& points = curves.back().points;
  ASSERT_EQ(points.size(), 2u);  // the moderate size, and four times that
  EXPECT_EQ(points[0].n, 3);
  EXPECT_EQ(points[0].in_set, 1);
  EXPECT_EQ(points[0].alone, 1);
  EXPECT_EQ(points[1].in_set, 1);
  EXPECT_EQ(points[1].alone, 0);
}

TEST(Tally, ReliabilityComparesWhatIsStatedWithWhatIsTrue) {
  int stated = 0, good = 0;
  double sum = 0;
  for (const Stated& s : ReliabilityOf(Some())) {
    stated += s.n, good += s.true_ones, sum += s.sum;
    EXPECT_TRUE(s.n == 0 || (s.from <= s.sum / s.n && s.sum / s.n <= s.to));
  }
  EXPECT_EQ(stated, 4);
  EXPECT_EQ(good, 2);
  EXPECT_NEAR(sum, 2, 1e-12);
  EXPECT_EQ(ReliabilityOf(Some()).back().true_ones, 1);
}

// 0.2 of 0.7 to the upper end is 0.56 standard deviations: within 43 % of a normal distribution.
TEST(Tally, CoverageTakesTheSideOfTheTruth) {
  for (const Coverage& c : CoverageOf(Some())) {
    EXPECT_EQ(c.n, 1);
    EXPECT_EQ(c.covered, c.nominal > 0.43) << c.nominal;
  }
  ASSERT_EQ(CoveredByGroup(Some()).size(), 1u);
  EXPECT_EQ(CoveredByGroup(Some()).front().covered, 1);
}

TEST(Report, ShowsEveryTable) {
  const std::string text = Report(Some());
  for (const char* const part :
       {"nothing hidden", "hidden and listed", "two hidden: both found 1 of 1",
        "hidden, and answer", "hidden, and likeliest name", "power", "x4: 1 (0) of 1",
        "reliability", "coverage"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(Report, OfNoCasesIsNoFailure) { EXPECT_THAT(Report({}), HasSubstr("nothing hidden")); }

TEST(Outcome, IsWhatItsLineSays) {
  Answer a;
  a.verdict = "named", a.named = {"payload"}, a.truth = 2, a.value = 1.8, a.low = 1;
  a.high = std::numeric_limits<double>::infinity();
  a.by_numbers = 0.1;
  a.stated = {{"payload", 0.75}};
  a.closest = 20;
  a.followed = {"a staircase", 40, {"payload"}, true, true};
  const Case c{{"payload"}, 2};
  const auto line = nlohmann::json::parse(LineOf(c, a).dump());
  const auto read = OutcomesOf({line, {{"case", "failed"}, {"verdict", "error"}}});
  ASSERT_EQ(read.size(), 1u);
  EXPECT_TRUE(read[0].right && read[0].unique && read[0].Covered());
  EXPECT_EQ(read[0].factor, 2);
  EXPECT_EQ(read[0].by_numbers, 0.1);
  EXPECT_EQ(read[0].stated.at("payload"), 0.75);
  ASSERT_TRUE(read[0].followed);
  EXPECT_TRUE(read[0].followed->right && read[0].followed->unique);
  EXPECT_THAT(Report(read), HasSubstr("apart by 15 or more: 1 of 1"));
  EXPECT_THAT(Report(read), HasSubstr("after the proposed experiment: one right name 1 of 1"));
}

TEST(Pictures, OfMatricesHaveACellForEveryCount) {
  const std::string svg = MatricesSvg({{"A & B", {"one", "two"}, {"x", "y"}, {{3, 0}, {1, 17}}}});
  EXPECT_THAT(svg, ::testing::StartsWith("<svg"));
  for (const char* const text : {"A &amp; B", ">one<", ">y<", ">3<", ">17<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, ::testing::Not(HasSubstr(">0<")));
}

}  // namespace
}  // namespace continuum::hidden
