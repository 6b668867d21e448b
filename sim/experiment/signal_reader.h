#pragma once

#include "sim/experiment/experiment.h"

namespace continuum {

class Yaml;

/// Reads one item of the list `inputs` of an experiment. Throws Error (file:line: key).
Input ReadInput(const Yaml& y);

/// Reads one item of the list `outputs` of an experiment. Throws Error (file:line: key).
Output ReadOutput(const Yaml& y);

}  // namespace continuum
