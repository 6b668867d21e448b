#include "identification/diagnosis/pair_fit.h"

#include <algorithm>

#include "identification/diagnosis/correction.h"
#include "identification/diagnosis/probing.h"

namespace continuum {
namespace {

// Whether the interval of a size leaves out its absence. It reaches over what the time step does.
bool IsThere(const Hypothesis& h, const Uncertainty& u, Eigen::Index begin) {
  for (const std::size_t a : h.Amplitudes()) {
    const Eigen::Index i = begin + static_cast<Eigen::Index>(a);
    const double null = std::min(h.null[a], h.extra[a].upper);
    if (null < u.lower[i] || null > u.upper[i]) return true;
  }
  return false;
}

}  // namespace

bool PairFit::BothAreThere() const {
  if (!complete()) return true;
  const Uncertainty& u = b->fitted.sensitivities->uncertainty;
  return IsThere(a->hypothesis, u, first_extra()) && IsThere(b->hypothesis, u, b->first_extra());
}

bool PairFit::FirstCorrects(const SearchContext& context) const {
  return OnlyCorrects(a->hypothesis, b->fitted, first_extra(), *context.fitter.experiment,
                      context.sizes, context.fitter.criteria);
}

bool PairFit::SecondCorrects(const SearchContext& context) const {
  return OnlyCorrects(b->hypothesis, b->fitted, b->first_extra(), *context.fitter.experiment,
                      context.sizes, context.fitter.criteria);
}

bool PairFit::AnyIsFarOff(const Criteria& criteria) const {
  return IsFarOff(a->hypothesis, b->fitted, first_extra(), criteria) ||
         IsFarOff(b->hypothesis, b->fitted, b->first_extra(), criteria);
}

std::vector<Problem::Vector> StartsBeside(const CandidateResult& first,
                                          const CandidateResult& second) {
  const Problem::Vector& pair = second.fitted.fit.x;
  const auto own = static_cast<Eigen::Index>(second.hypothesis.extra.size());
  const auto others = pair.size() - own - static_cast<Eigen::Index>(second.hypothesis.given.size());
  const Problem::Vector alone = Append(first.fitted.fit.x, {pair.end() - own, pair.end()});
  Problem::Vector beside = alone;
  beside.head(others) = pair.head(others);
  return {alone, beside};
}

}  // namespace continuum
