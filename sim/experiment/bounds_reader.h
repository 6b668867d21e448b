#pragma once

#include "error.h"
#include "sim/experiment/experiment.h"
#include "sim/io/yaml.h"

namespace continuum {

/// Reads `lower` and `upper` of a parameter. Throws Error (file:line: key) where upper is not
/// above.
inline void ReadBounds(const Yaml& y, Parameter& p) {
  p.lower = y.At("lower").Number();
  p.upper = y.At("upper").Number();
  if (p.lower < p.upper) return;
  throw Error::Input(y.At("upper").Where(), "a number above lower, " + y.At("lower").Text(),
                     y.At("upper").Text());
}

}  // namespace continuum
