#pragma once

#include <string>
#include <vector>

#include "identification/problem/problem.h"
#include "identification/result/confounding.h"
#include "identification/result/uncertainty.h"

namespace continuum {

/// Directions of the information matrix H (unit diagonal) in which the data say less than a
/// hundredth of what they say about single parameters: eigenvectors with eigenvalues λ < 0.01, and
/// freedom 1/√λ. Of those that nobody sees (λ < 1e-8) any mixture is one too: they are named
/// together where they move the same parameters. In the text, changes are relative to the values
/// where none of them is zero.
std::vector<Confounding> ConfoundingsOf(const Problem& problem, const Problem::Vector& x,
                                        const Uncertainty& uncertainty);

}  // namespace continuum
