#pragma once

#include <string>
#include <vector>

#include "identification/candidates/hypothesis.h"
#include "identification/candidates/object_sets.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// Where an effect is tried for which the experiment names no place.
enum class SearchScope {
  kFew,    ///< at all objects of a kind together, and at each where they are few
  kOthers  ///< at the others: each of many, each that shares a parameter, tendons beside joints
};

/// The candidates of an experiment that make sense in its model, one Hypothesis per effect, choice
/// and place; where it lists all, of the effects whose card does not say kOnlyListed. skipped: gets
/// one sentence for each that does not, and for the objects of a place that an effect cannot act
/// on: it acts on the others. Throws Error for a place or a condition that the experiment names and
/// does not have.
std::vector<Hypothesis> MakeCandidates(const Experiment& experiment, const SearchBase& from,
                                       const Sizes& sizes, std::vector<std::string>& skipped,
                                       SearchScope places = SearchScope::kFew);

/// The same of a list in place of the experiment's.
std::vector<Hypothesis> MakeCandidates(const std::vector<Candidate>& list,
                                       const Experiment& experiment, const SearchBase& from,
                                       const Sizes& sizes, std::vector<std::string>& skipped,
                                       SearchScope places = SearchScope::kFew);

/// Effects of the catalog that the experiment's list of candidates leaves out; none where it lists
/// all, or none. Not those whose card says kOnlyListed. names: the list to take in place of the
/// experiment's, if any.
std::vector<std::string> Unlisted(const Experiment& experiment,
                                  const std::vector<std::string>& names);

}  // namespace continuum
