#pragma once

#include <string>
#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// Throws Error (kInput; parameter, its line, log) where a start, a frozen value or a bound is one
/// that no machine can have, and where a log's model does not compile at the start of a fit.
void RequireStartModels(const Problem& problem);

/// Throws Error (kInput; parameter and its line) when a parameter changes no output of any log, by
/// the derivatives J at x. One that a fit has moved did change something: a delay below the time
/// step changes nothing any more.
void RequireEffect(const Problem& problem, const Problem::Vector& x,
                   const std::vector<Problem::Matrix>& J);

/// Throws Error (kJob; parameters, their lines and values) when derivatives J at x are no numbers.
void RequireFiniteSlopes(const Problem& problem, const Problem::Vector& x,
                         const std::vector<Problem::Matrix>& J);

/// Why the simulation of a log diverges at x, in words: when, and by which of its parameters'
/// values alone, if by one, by what the log sets, or as the model stands.
std::string WhyItDiverges(const Problem& problem, const Problem::Vector& x, std::size_t log);

}  // namespace continuum
