#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// One start of several, and where its fit ended.
struct Start {
  Problem::Vector x;
  double cost = 0;  ///< infinite where the simulation diverges at the start
};

/// A fit from several starts: x, then random points within the bounds, in equal
/// ratios where these span more than a factor of ten. Those that cannot come near the best any more
/// give up.
struct MultiStart {
  Fit best;
  std::vector<Start> starts;  ///< in the order in which they were tried

  /// How many ended within a share of the best cost.
  std::size_t Reached(double share = 1e-3) const;
  /// "3 of 5 starts end within 0.1 % of the best cost"
  std::string InWords() const;
};
/// Repeats exactly for a seed. Throws Error as FitParameters, and when every start diverges.
MultiStart FitFromMany(const Problem& problem, const Problem::Vector& x,
                       const std::vector<bool>& use, int starts, std::uint64_t seed,
                       const FitOptions& options = {});

}  // namespace continuum
