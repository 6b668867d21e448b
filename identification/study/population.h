#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "identification/study/random_effects.h"
#include "identification/study/row_result.h"
#include "identification/study/row_status.h"

namespace continuum {

/// A row with how it stands and what it found.
struct StudyLine {
  const StudyRow* row;
  RowStatus status;
  RowResult result;  ///< of a row that is done
};

/// A unit's value of a parameter.
struct PopulationUnit {
  std::size_t line;  ///< its row, an index into the lines
  RowParameter parameter;
  UnitDeviation deviation;
};

/// One parameter of one model over many units.
struct Population {
  std::string model;  ///< file name
  std::string name, unit;
  std::vector<PopulationUnit> units;
  RandomEffects spread;
  std::vector<std::size_t> left_out;  ///< lines without an interval, or at a bound
};

/// Of each parameter of `identify` that three rows or more have whose models' files have one name.
/// A standard error is half the width of the 95 % interval, over 1.96. Starts of trials
/// (start:JOINT) are no parameters of a unit.
std::vector<Population> PopulationsOf(const std::vector<StudyLine>& lines);

/// Names of the lines that are odd.
std::vector<std::string> OddUnits(const Population& population,
                                  const std::vector<StudyLine>& lines);

}  // namespace continuum
