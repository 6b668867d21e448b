#pragma once

#include <string>
#include <vector>

#include "identification/statistics/uncertainty.h"

namespace continuum {

/// Parameters that can move together with little change of what is measured.
struct Confounding {
  std::vector<std::string> names;
  /// How much farther they can move together than one of them alone; infinite: without any change.
  double freedom;
  std::string text;  ///< "mass and gain trade off: … only mass/gain is determined"
};

/// Directions of the information matrix H (unit diagonal) in which the data say less than a
/// hundredth of what they say about single parameters: eigenvectors with eigenvalues λ < 0.01, and
/// freedom 1/√λ. Of those that nobody sees (λ < 1e-8) any mixture is one too: they are told
/// together where they move the same parameters. In the text, changes are relative to the values
/// where none of them is zero.
std::vector<Confounding> TradeOffsOf(const Problem& problem, const Problem::Vector& x,
                                     const Uncertainty& uncertainty);

}  // namespace continuum
