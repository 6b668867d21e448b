#include "identification/diagnosis/unseen_effects.h"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "identification/diagnosis/search_rules.h"

namespace continuum {
namespace {

bool HadALook(const Dismissed& one) { return one.why != Dismissed::Why::kNoTimeForALook; }
bool HadTheChance(const Dismissed& one) {
  return HadALook(one) && one.why != Dismissed::Why::kNoTimeForAFit;
}

// Of fitted candidates, and of those dismissed that had what is asked for.
std::set<std::string> EffectsWith(const Diagnosis& d, bool (*had)(const Dismissed&)) {
  std::set<std::string> with;
  for (const CandidateResult& c : d.candidates) with.insert(c.hypothesis.effect);
  for (const Dismissed& one : d.dismissed) {
    if (had(one)) with.insert(one.effect);
  }
  return with;
}

std::vector<std::string> EffectsWithout(const Diagnosis& d, bool (*had)(const Dismissed&)) {
  std::set<std::string> known = EffectsWith(d, had);
  std::vector<std::string> without;
  for (const Dismissed& one : d.dismissed) {
    if (known.insert(one.effect).second) without.push_back(one.effect);
  }
  return without;
}

bool TooManyWithout(const Diagnosis& d, bool (*had)(const Dismissed&)) {
  const std::size_t without = EffectsWithout(d, had).size();
  return TooManyUnseen(without, without + EffectsWith(d, had).size(), d.criteria);
}

bool AnyWasFitted(const Diagnosis& d) {
  return std::any_of(d.candidates.begin(), d.candidates.end(),
                     [](const CandidateResult& c) { return c.was_fitted; });
}

// Why what was tried does not tell that nothing is missing: too few candidates, or not even a force
// without a name. Empty where it does.
std::string WhyNothingIsKnown(const Diagnosis& d) {
  if (NothingWasTried(d) || TooManyWithout(d, HadTheChance)) {
    const std::size_t without = EffectsWithout(d, HadTheChance).size(),
                      all = without + EffectsWith(d, HadTheChance).size();
    return fmt::format("there was no time to try {} of {} effects", without, all);
  }
  if (AnyWasFitted(d) || d.left_out.empty()) return "";
  return "no candidate was fitted, and there was no time for " + d.left_out.front();
}

}  // namespace

std::vector<std::string> UnseenEffects(const Diagnosis& d) { return EffectsWithout(d, HadALook); }

bool TooManyUnseen(const Diagnosis& d) { return TooManyWithout(d, HadALook); }

bool NothingWasTried(const Diagnosis& d) {
  return !AnyWasFitted(d) &&
         std::any_of(d.dismissed.begin(), d.dismissed.end(), std::not_fn(HadTheChance));
}

void WeighUnseen(Diagnosis& d) {
  if (d.Is(Verdict::Kind::kAdequate) && !d.noise.known()) {
    const std::string why = WhyNothingIsKnown(d);
    if (!why.empty()) d.verdict = {Verdict::Kind::kUnexplained, {}, why};
    d.verdict.open = !why.empty();
  }
  if (!d.Is(Verdict::Kind::kNamed) || !TooManyUnseen(d)) return;
  d.verdict.kind = Verdict::Kind::kAmbiguous;
  d.verdict.reason = fmt::format("there was no time for a look at {} effects; of the others: {}",
                                 UnseenEffects(d).size(), d.verdict.reason);
}

}  // namespace continuum
