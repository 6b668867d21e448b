#pragma once

#include "identification/diagnosis/candidate_search.h"

namespace continuum {

/// A cause that was fitted beside another one.
struct PairFit {
  std::size_t base;          ///< index of the search for a second cause beside the first
  std::size_t second;        ///< index of the second among its candidates
  const CandidateResult* a;  ///< the first, alone
  CandidateResult* b;        ///< the second, beside it

  /// Gained by both.
  double likelihood() const { return a->likelihood + b->likelihood; }
  bool complete() const { return b->fitted.complete(); }
  /// Whether neither may be absent, by the intervals of their sizes; true where these are not
  /// known, as it is plainly behind, or out of time.
  bool BothAreThere() const;
  /// OnlyCorrects of the one and the other, beside each other.
  bool FirstCorrects(const SearchContext& context) const;
  bool SecondCorrects(const SearchContext& context) const;
  /// IsFarOff of any of both.
  bool AnyIsFarOff(const Criteria& criteria) const;

 private:
  Eigen::Index first_extra() const {
    return b->first_extra() - static_cast<Eigen::Index>(a->hypothesis.extra.size());
  }
};

/// Where a second cause begins beside a first one, from its fit beside another one: the other
/// parameters as the first one wants them alone, or as they were in that fit.
std::vector<Problem::Vector> StartsBeside(const CandidateResult& first,
                                          const CandidateResult& second);

}  // namespace continuum
