#pragma once

#include "sim/experiment/experiment.h"

namespace continuum {

class Yaml;

/// Reads one item of the list `logs` of an experiment, with the rows of its file (CSV or MAT), in
/// SI. experiment: with its inputs and channels; time_unit: seconds per unit of the time column.
/// Throws Error (file:line, key or column).
Log ReadLog(const Yaml& y, const Experiment& experiment, double time_unit);

/// Values by target and attribute: {"joint:hinge": {damping: 0.1}}.
std::vector<Change> ReadSettings(const Yaml& y);

}  // namespace continuum
