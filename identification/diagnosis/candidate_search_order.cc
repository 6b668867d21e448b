#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "binding/effect_catalog.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/family_starts.h"

// In which order the candidates of a search are fitted.
namespace continuum {

// By whichever view promises more, as a share of what the best one promises there.
double CandidateSearch::Promise(const CandidateResult& c, double most) {
  return std::max({most > 0 ? c.explained / most : 0, c.force_promise, c.error_promise});
}

// The plainest law of a family goes first at a place, as if it promised what the best of them does:
// what it leaves decides whether a richer one is needed.
void CandidateSearch::OrderByPromise() {
  constexpr double kRicher = 0.8;
  const double most = MostExplained();
  const auto group = [](const CandidateResult& c) {
    return std::pair(KinOf(c.hypothesis.Card()).family, c.hypothesis.where);
  };
  std::map<std::pair<std::string, std::string>, double> best;
  for (const CandidateResult& c : candidates) {
    double& promise = best[group(c)];
    promise = std::max(promise, Promise(c, most));
  }
  const auto key = [&](const CandidateResult& c) {
    const Kin kin = KinOf(c.hypothesis.Card());
    if (kin.family.empty()) return Promise(c, most);
    return kin.depth == 0 ? best.at(group(c)) : kRicher * Promise(c, most);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const auto& a, const auto& b) { return key(a) > key(b); });
}

// Those that change the outputs as one before them does go last: what that one reaches tells what
// they will. How many are different.
std::size_t CandidateSearch::Order() {
  OrderByPromise();
  constexpr double kAlike = 0.1;  // of the squares that the better one explains
  const Problem::Vector z = ScreenedResidual().vector();
  std::vector<const CandidateResult*> first;
  std::vector<Problem::Vector> change;
  const auto are_alike = [&](const CandidateResult& c, const Problem::Vector& own, std::size_t k) {
    return c.force_promise <= first[k]->force_promise &&
           c.error_promise <= first[k]->error_promise &&
           (own - change[k]).squaredNorm() <= kAlike * std::max(c.explained, first[k]->explained);
  };
  for (CandidateResult& c : candidates) {
    c.like.reset();
    if (c.probes.empty()) {
      first.push_back(&c), change.emplace_back(Problem::Vector::Zero(z.size()));
      continue;
    }
    const Probe& probe = c.probes.front();
    const Problem::Vector own = probe.columns * ExplainedBy(probe, z).coefficients;
    std::size_t k = 0;
    while (k < first.size() && !are_alike(c, own, k)) ++k;
    if (k < first.size()) {
      c.like = k;
    } else {
      first.push_back(&c), change.push_back(own);
    }
  }
  const std::size_t different = first.size();
  std::stable_partition(candidates.begin(), candidates.end(),
                        [](const CandidateResult& c) { return !c.like; });
  return different;
}

// The others behind the one that they are like, those of the best one first.
void CandidateSearch::OrderAlike(std::size_t different) {
  const auto cost = [&](const CandidateResult& c) {
    const CandidateResult& first = candidates[c.like.value()];
    return first.was_fitted ? first.fitted.fit.cost : kInfinity;
  };
  std::stable_sort(candidates.begin() + static_cast<std::ptrdiff_t>(different), candidates.end(),
                   [&](const auto& a, const auto& b) { return cost(a) < cost(b); });
}

}  // namespace continuum
