#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hidden_effects/outcome.h"

namespace continuum::hidden {

/// Counts with a name for every row and column.
struct Matrix {
  std::string title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<int>> count;  ///< [row][column]
};

/// Of what family an effect is ("dry friction", "lateness", "mass"), or else of what kind
/// ("friction", "force", "load", "input", "measurement", …).
std::string GroupOf(const std::string& effect);

/// What is hidden, by group, against the group of the likeliest name.
Matrix Confusion(const std::vector<Outcome>& outcomes);
/// What is hidden, by group, against what the answer is worth.
Matrix Worth(const std::vector<Outcome>& outcomes);

/// How often one listed effect of a group is found, over its size.
struct Power {
  std::string group;
  struct Point {
    double factor;  ///< of the moderate size
    int n = 0, in_set = 0, alone = 0;
  };
  std::vector<Point> points;
};
/// Of every group, and of all.
std::vector<Power> PowerOf(const std::vector<Outcome>& outcomes);

/// Effects of one listed effect's cases that were given about the same probability.
struct Stated {
  double from, to;
  int n = 0, true_ones = 0;
  double sum = 0;  ///< of their probabilities
};
std::vector<Stated> ReliabilityOf(const std::vector<Outcome>& outcomes);

/// Of the sizes of named effects: how many lie in intervals of a nominal share, which the 95 %
/// intervals make if errors are normal.
struct Coverage {
  double nominal;
  int n = 0, covered = 0;
};
std::vector<Coverage> CoverageOf(const std::vector<Outcome>& outcomes);

/// Intervals of 95 % that hold the truth, by group of what is hidden.
struct Covered {
  std::string group;
  int n = 0, covered = 0;
};
std::vector<Covered> CoveredByGroup(const std::vector<Outcome>& outcomes);

}  // namespace continuum::hidden
