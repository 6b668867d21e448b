#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/diagnosis/law_rows.h"
#include "sim/experiment/experiment.h"

namespace continuum {

/// A law that the missing force suggests.
struct SuggestedLaw {
  std::vector<std::string> joints;
  WrittenLaw law;    ///< begins with the sizes and shapes that were found
  double share = 0;  ///< of the squares of the missing force that the parameters leave
};

/// Looks for a formula in the missing force (DIAGNOSIS 7b).
///
/// With C what the fitted parameters do at the measured states, and φ(s) the parts of a term of
/// shape s at one joint, at two, or at all alike,
///
///   f ≈ C a + φ(s) b,                                                      (1)
///
/// b by least squares, s by a search from a grid. Every term of the library is tried at every
/// place; those that take most are refined, scored on the folds, and given a second term where the
/// folds say so. A term must take more than any of them takes of kShifted missing forces whose logs
/// are moved round: these are as large and as smooth, and of nothing that the joint does then.
///
/// Returns the best few, each of another term or place, best first; none where chance does as well,
/// or a number of the model that is off.
std::vector<SuggestedLaw> SuggestLaws(const LawRows& rows, std::uint64_t seed, std::size_t most);

}  // namespace continuum
