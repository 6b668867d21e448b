#pragma once

#include "identification/diagnosis/candidate_search.h"

namespace continuum {

/// What every candidate could explain beside a first cause, which has to stay where it is.
/// hopeless: CandidateSearch::HopelessBeside.
CandidateSearch ScreenBeside(const SearchContext& context, const CandidateResult& first,
                             const std::set<std::string>& hopeless = {});

/// Two causes that act together.
struct Pair {
  CandidateSearch search;  ///< for the second cause: its base has the first
  Partner first;
  double first_likelihood;  ///< gained by the first alone
  Verdict verdict;          ///< on the second; indices into search.candidates
  LackOfFit lack_of_fit;

  /// Whether neither is a rich law of its family, and both leave nothing but noise.
  bool IsPlainAndEnough() const;
};

struct PairsFound {
  std::optional<Pair> best = {};      ///< none: no second cause takes enough
  std::vector<PairTried> tried = {};  ///< best first
  std::string would_take = {};        ///< what the second cause of the best takes, in words
};

/// Looks for two causes when one is not enough: forward from the best single candidates, and
/// backward, since the first may have been taken for two that together do better: the partner that
/// was found becomes the base, until nothing changes.
///
/// A second cause is named when it takes second_share of what can be explained at all, or the main
/// share of what the first leaves and this helps on logs left out too; when both are there beyond
/// their intervals, and both together leave noise or take the main share. What takes less is only
/// told; so is what corrects a number of the model by a few per cent and is small beside the first.
/// single: a search that has been fitted; of_step: the time-discretisation error
/// may explain the residual of its best, so that a second cause must explain most of it.
PairsFound FindPair(const SearchContext& context, const CandidateSearch& single, bool of_step);

}  // namespace continuum
