#pragma once

#include "identification/diagnosis/candidate_search.h"

namespace continuum {

/// Two causes that act together and whose residual is noise.
struct Pair {
  CandidateSearch search;  ///< for the second cause: its base has the first
  Hypothesis first;
  double first_likelihood;              ///< gained by the first alone
  std::vector<std::string> equivalent;  ///< effects that could stand for the first
  Verdict verdict;                      ///< on the second; indices into search.candidates
  LackOfFit lack_of_fit;
  std::vector<PairTried> tried;  ///< best first
};

/// Looks for two causes when no single one's residual is noise: forward from the best single
/// candidates, and backward, since the first may have been taken for two that together do better:
/// the partner that was found becomes the base, until nothing changes.
///
/// single: a search that has been fitted; of_step: the time-discretisation error may explain the
/// residual of its best, so that a second cause must explain most of it. Nothing when no pair's
/// residual is noise.
std::optional<Pair> FindPair(const SearchContext& context, const CandidateSearch& single,
                             bool of_step);

}  // namespace continuum
