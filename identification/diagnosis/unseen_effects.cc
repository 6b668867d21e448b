#include "identification/diagnosis/unseen_effects.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "identification/diagnosis/search_rules.h"

namespace continuum {
namespace {

bool HadALook(const Dismissed& one) { return one.why != Dismissed::Why::kNoTimeForALook; }

std::set<std::string> SeenEffects(const Diagnosis& d) {
  std::set<std::string> seen;
  for (const CandidateResult& c : d.candidates) seen.insert(c.hypothesis.effect);
  for (const Dismissed& one : d.dismissed) {
    if (HadALook(one)) seen.insert(one.effect);
  }
  return seen;
}

}  // namespace

std::vector<std::string> UnseenEffects(const Diagnosis& d) {
  std::set<std::string> known = SeenEffects(d);
  std::vector<std::string> unseen;
  for (const Dismissed& one : d.dismissed) {
    if (known.insert(one.effect).second) unseen.push_back(one.effect);
  }
  return unseen;
}

bool TooManyUnseen(const Diagnosis& d) {
  const std::size_t unseen = UnseenEffects(d).size();
  return TooManyUnseen(unseen, unseen + SeenEffects(d).size(), d.criteria);
}

bool NothingWasTried(const Diagnosis& d) {
  const auto fitted = [](const CandidateResult& c) { return c.was_fitted; };
  const auto no_time = [](const Dismissed& one) {
    return one.why == Dismissed::Why::kNoTimeForALook || one.why == Dismissed::Why::kNoTimeForAFit;
  };
  return std::none_of(d.candidates.begin(), d.candidates.end(), fitted) &&
         std::any_of(d.dismissed.begin(), d.dismissed.end(), no_time);
}

void WeighUnseen(Diagnosis& d) {
  if (d.Is(Verdict::Kind::kAdequate) && !d.noise.known() && NothingWasTried(d))
    d.verdict = {Verdict::Kind::kUnexplained, {}, "there was no time to try a candidate"};
  if (!d.Is(Verdict::Kind::kNamed) || !TooManyUnseen(d)) return;
  d.verdict.kind = Verdict::Kind::kAmbiguous;
  d.verdict.reason = fmt::format("there was no time for a look at {} effects; of the others: {}",
                                 UnseenEffects(d).size(), d.verdict.reason);
}

}  // namespace continuum
