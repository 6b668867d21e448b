#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hidden_effects/outcome.h"

namespace continuum::hidden {

/// Shares between which a measure is good, ends included.
struct Goal {
  double low = 0, high = 1;
};

/// One line of the table that says how good a diagnosis is.
struct Measure {
  std::string name;
  std::optional<Goal> small, large;  ///< of the tests, and of the benchmark; none: not asked
  double reached = 0;                ///< a share
  int n = 0;                         ///< cases that it is a share of; 0: it was not measured

  bool Meets(const std::optional<Goal>& goal) const;
};

/// What the suites measure, of all outcomes together. Each measure takes the cases of its suite.
std::vector<Measure> MeasuresOf(const std::vector<Outcome>& outcomes);

/// As text: measure, goals, what was reached, of how many.
std::string MeasureTable(const std::vector<Measure>& measures);

/// Whether an answer is what it should be:
///   nothing hidden       no name, or where the machine is 1 % off its model a mass;
///   wrong logs           no name alone, but a lateness where the outputs are late;
///   not listed           no name alone, or a declared sibling's;
///   one or two effects   both among at most four names.
bool IsRight(const Outcome& o);

}  // namespace continuum::hidden
