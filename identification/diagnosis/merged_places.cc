#include "identification/diagnosis/merged_places.h"

#include <string>

namespace continuum {
namespace {

// Whether nothing but this may stand for the cause beside it.
bool IsOne(const Partner& partner) {
  return partner.equivalent.empty() && partner.instead.empty() &&
         partner.correction != Partner::Correction::kBoth;
}

}  // namespace

void MergePlaces(Diagnosis& d) {
  auto& named = d.verdict.named;
  if (named.size() < 2) return;
  const std::string& effect = d.candidates[named.front()].hypothesis.effect;
  std::string places;
  for (const std::size_t i : named) {
    const Hypothesis& h = d.candidates[i].hypothesis;
    if (h.effect != effect) return;
    places += (places.empty() ? "" : ", ") + (h.variant.empty() ? h.where : h.NameAtPlace());
  }
  if (!d.partner) {
    d.verdict.reason = d.noise_limited
                           ? "its residual shows " + ResidualInWords(d.lack_of_fit, d.criteria)
                           : "it passes all rules and is clearly better than every other effect";
  }
  if (!d.partner || IsOne(*d.partner)) d.verdict.kind = Verdict::Kind::kNamed;
  d.verdict.reason += "; the data do not distinguish these places: " + places;
  named.resize(1);
}

bool IsOnePair(const Partner& first, std::size_t others) {
  using Correction = Partner::Correction;
  const bool other_is_one = others == 1 && first.instead.empty();
  if (first.correction == Correction::kBoth) return false;
  return (first.equivalent.empty() || first.correction == Correction::kThis) &&
         (other_is_one || first.correction == Correction::kOther);
}

}  // namespace continuum
