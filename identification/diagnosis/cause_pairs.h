#pragma once

#include "identification/diagnosis/candidate_search.h"

namespace continuum {

/// Two causes that act together and leave nothing but noise.
struct Pair {
  CandidateSearch round;  ///< for the second cause: its base has the first
  Hypothesis first;
  double first_likelihood;              ///< gained by the first alone
  std::vector<std::string> equivalent;  ///< effects that could stand for the first
  Verdict verdict;                      ///< on the second; indices into round.candidates
  LackOfFit lack;
  std::vector<PairTried> tried;  ///< best first
};

/// Looks for two causes when no single one leaves noise: forward from the best single candidates,
/// and backward, since the first may have been taken for two that together do better: the partner
/// that was found becomes the base, until nothing changes. single: a round that has been fitted;
/// excused: what its best leaves may be the time step's doing, so that a second cause must explain
/// nearly all of it. Nothing when no pair leaves noise.
std::optional<Pair> FindPair(const CandidateFitter& trials, const CandidateSearch& single,
                             bool excused, const Noise& noise, const Sizes& sizes,
                             const DiagnosisOptions& options);

}  // namespace continuum
