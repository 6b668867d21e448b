#pragma once

#include "sim/experiment/experiment.h"

namespace continuum {

class Yaml;

/// Reads a candidate whose law is written in the experiment, of effect `formula` (key `force`) or
/// `formula_friction` (key `level`). Throws Error (file:line: key).
Candidate ReadWrittenLaw(const Yaml& y, const std::string& effect);

/// Whether an effect's law is written where it is used.
bool IsWritten(const std::string& effect);

}  // namespace continuum
