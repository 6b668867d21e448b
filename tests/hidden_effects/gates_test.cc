#include "hidden_effects/gates.h"

#include <functional>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "binding/effect_catalog.h"

namespace continuum::hidden {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A diagnosis that looks at the candidates, but not at the logs.
using Mutant = std::function<Answer(const Case& c)>;

Answer Saying(const std::string& verdict, std::vector<std::string> named,
              std::vector<std::string> partner = {}) {
  Answer a;
  a.verdict = verdict, a.named = std::move(named), a.partner = std::move(partner);
  a.low = -kInfinity, a.high = kInfinity;  // holds any size
  return a;
}

std::vector<std::string> Candidates(const Case& c) {
  std::istringstream list(CandidatesOf(c));
  std::vector<std::string> names;
  for (std::string name; std::getline(list >> std::ws, name, ',');) names.push_back(name);
  return names;
}

Answer Adequate(const Case&) { return Saying("adequate", {}); }
Answer Unexplained(const Case&) { return Saying("unexplained", {}); }
Answer FirstCandidate(const Case& c) { return Saying("named", {Candidates(c).front()}); }
Answer AllCandidates(const Case& c) { return Saying("ambiguous", Candidates(c)); }
Answer AnyTwo(const Case& c) { return Saying("ambiguous", Candidates(c), Candidates(c)); }

// As a perfect diagnosis answers.
Answer Truth(const Case& c) {
  if (c.background && c.effects.empty()) return Saying("unexplained", {});
  if (c.effects.empty()) return Saying("adequate", {});
  if (!c.listed) return Saying("unexplained", {});
  if (c.effects.size() == 1) return Saying("named", c.effects);
  return Saying("ambiguous", {c.effects.front()}, {c.effects.back()});
}

bool Passes(const Mutant& mutant, const Gate& gate) {
  std::vector<Asked> asked;
  for (const Case& c : gate.cases) asked.push_back({c, mutant(c)});
  return gate.holds(asked);
}

// Of the gates where something is hidden that is among the candidates.
int Passed(const Mutant& mutant) {
  int passed = 0;
  for (const Gate& gate : Gates())
    passed += gate.finds && gate.cases.front().listed && Passes(mutant, gate);
  return passed;
}

TEST(Gates, LetTheTruthPass) {
  for (const Gate& gate : Gates()) EXPECT_TRUE(Passes(Truth, gate)) << gate.name;
}

TEST(Gates, ThatFindLetNoAnswerPassThatIsAlwaysTheSame) {
  for (const Mutant mutant : {Adequate, Unexplained, AllCandidates, AnyTwo})
    EXPECT_EQ(Passed(mutant), 0);
}

// The same effect is hidden in no more than a few of them.
TEST(Gates, LetNoNamePassEverywhere) {
  EXPECT_LE(Passed(FirstCandidate), 3);
  for (const EffectInfo& effect : Catalog()) {
    const auto always = [&](const Case&) { return Saying("named", {std::string(effect.name)}); };
    EXPECT_LE(Passed(always), 3) << effect.name;
  }
}

// The other gates see to it that nothing is named without a reason.
TEST(Gates, OfCasesWithoutACandidateRejectNames) {
  for (const Gate& gate : Gates()) {
    if (gate.finds && gate.cases.front().listed) continue;
    EXPECT_FALSE(Passes(FirstCandidate, gate)) << gate.name;
    EXPECT_EQ(Passes(AllCandidates, gate), gate.cases.front().background) << gate.name;
    EXPECT_EQ(Passes(Adequate, gate), !gate.finds) << gate.name;
  }
}

}  // namespace
}  // namespace continuum::hidden
