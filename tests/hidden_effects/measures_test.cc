#include "hidden_effects/measures.h"

#include <functional>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hidden_effects/outside/cases.h"

namespace continuum::hidden {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Answer Saying(const std::string& verdict, std::vector<std::string> named,
              std::vector<std::string> partner = {}) {
  Answer a;
  a.verdict = verdict, a.named = std::move(named), a.partner = std::move(partner);
  a.closest = 100, a.p = 1e-9;
  return a;
}

// The outside suite; of the arm nothing hidden twenty times, each effect alone, listed or not, and
// a pair; the same with the background, and logs that are wrong.
std::vector<Case> Some() {
  std::vector<Case> all = OutsideCases(false);
  for (int n = 0; n < 20; ++n) all.push_back({});
  for (const bool background : {false, true}) {
    for (const char* const effect : {"payload", "armature", "cubic_stiffness", "pt1", "dahl"}) {
      for (const bool listed : {true, false}) {
        Case c{{effect}, 2};
        c.listed = listed, c.background = background;
        if (listed || !background) all.push_back(c);
      }
    }
  }
  all.push_back({{"payload", "coulomb"}, 2});
  all.emplace_back().background = true;
  for (const char* const how : {"turned", "late", "flipped", "exchanged"})
    all.emplace_back().spoilt = how;
  return all;
}

// As a perfect diagnosis at a level of 5 % answers: of twenty times nothing one is an alarm.
Answer Truth(const Case& c, int turn) {
  const bool wrong = c.background || !c.spoilt.empty();
  if (c.effects.empty() && wrong) return Saying("unexplained", {});
  if (c.effects.empty()) return Saying(turn % 20 == 0 ? "unexplained" : "adequate", {});
  if (!c.listed) return Saying("unexplained", {});
  if (c.effects.size() == 2) return Saying("ambiguous", {c.effects[0]}, {c.effects[1]});
  Answer a = Saying("named", c.effects);
  a.explained = 1;
  const Hidden& h = RobotNamed(c.robot).Named(c.effects.front());
  if (c.robot == "pendulum") a.value = a.truth = h.null + h.size * c.factor;
  return a;
}

std::vector<Outcome> Outcomes(const std::function<Answer(const Case&, int)>& diagnosis) {
  std::vector<nlohmann::json> lines;
  int turn = 0;
  for (const Case& c : Some()) lines.push_back(LineOf(c, diagnosis(c, turn++)));
  return OutcomesOf(lines);
}

// Names of the goals of the benchmark that are missed.
std::vector<std::string> Missed(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> names;
  for (const Measure& m : MeasuresOf(outcomes)) {
    if (!m.Meets(m.large)) names.push_back(m.name);
  }
  return names;
}

TEST(Measures, AreAllMetByTheTruth) {
  EXPECT_THAT(Missed(Outcomes(Truth)), IsEmpty());
  std::map<std::string, int> n;
  for (const Measure& m : MeasuresOf(Outcomes(Truth))) n[m.name] = m.n;
  EXPECT_EQ(n.at("outside: right"), std::ssize(OutsideCases(false)));
  EXPECT_GT(n.at("outside: isolable, right and alone"), 20);
  EXPECT_GT(n.at("outside: pairs, both"), 5);
  EXPECT_EQ(n.at("outside: 2 kg on the pendulum within 15 %"), 1);
}

TEST(Measures, AreMissedByAnswersThatAreAlwaysTheSame) {
  for (const Answer& always :
       {Saying("adequate", {}), Saying("unexplained", {}), Saying("named", {"coulomb"}),
        Saying("named", {"payload"}), Saying("ambiguous", {"coulomb", "payload", "pt1"}),
        Saying("no answer", {})}) {
    const auto missed = Missed(Outcomes([&](const Case&, int) { return always; }));
    for (const char* const name :
         {"outside: right", "outside: one effect, in the set", "outside: pairs, both",
          "truth in the set, detection power >= 0.9"})
      EXPECT_THAT(missed, Contains(name)) << always.verdict;
  }
}

TEST(Measures, CountAFamilyWhereTheTruthIsMadeByAnotherLaw) {
  Case c{{"coulomb"}};
  c.robot = "valve";
  EXPECT_FALSE(InSet(c, Saying("named", {"dahl"})));
  c.law = Law::kBristles;
  EXPECT_TRUE(InSet(c, Saying("named", {"dahl"})));
  EXPECT_FALSE(InSetExactly(c, Saying("named", {"dahl"})));
  EXPECT_FALSE(InSet(c, Saying("named", {"pt1"})));
}

TEST(Measures, AreATableWithGoals) {
  const std::string table = MeasureTable(MeasuresOf(Outcomes(Truth)));
  for (const char* const part : {"goal large", "2.9 to 7.1 %", "<= 1 %", "not run", ">= 95 %"})
    EXPECT_THAT(table, HasSubstr(part));
}

TEST(OutsideCases, HaveNamesOfTheirOwnAndAQuickPart) {
  std::map<std::string, int> names;
  for (const Case& c : OutsideCases(false)) ++names[c.Name()];
  for (const auto& [name, n] : names) EXPECT_EQ(n, 1) << name;
  for (const Case& c : OutsideCases(true)) EXPECT_TRUE(names.contains(c.Name()));
}

}  // namespace
}  // namespace continuum::hidden
