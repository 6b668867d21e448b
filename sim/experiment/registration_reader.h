#pragma once

#include "sim/experiment/registration.h"

namespace continuum {

class Yaml;

/// Reads the key `registration` of an experiment. Throws Error (file:line: key).
Registration ReadRegistration(const Yaml& y);

}  // namespace continuum
