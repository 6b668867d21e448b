#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// A column of a log as `check` looks at it: in its unit, rows without a number left out.
struct CheckedColumn {
  std::string name, unit;
  bool input = false;
  bool smooth = false;  ///< a sensor, which physics keeps from jumping
  std::vector<double> time, value;
  std::vector<std::size_t> row;  ///< of the log
  std::size_t missing = 0;
  double quantum = 0;
  std::string sensor;  ///< of which it is one direction
  double bend = 0;     ///< BendOf the sensor, of all its directions in all logs

  bool constant() const;
};

/// A log with its columns, inputs first (those without a column are left out).
struct CheckedLog {
  const Experiment* experiment;
  const Log* log;
  std::vector<CheckedColumn> columns;
  double period;                ///< median interval [s]
  double usual_period;          ///< the median of that over all logs [s]
  std::vector<bool> disturbed;  ///< [row] a gap or a step of an input just before
};

/// All logs of an experiment. What belongs to a sensor (its steps, its noise) and the usual period
/// come from all logs together.
std::vector<CheckedLog> PrepareLogs(const Experiment& e);

}  // namespace continuum
