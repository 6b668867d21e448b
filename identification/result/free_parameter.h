#pragma once

#include <string>
#include <vector>

#include "sim/model/change.h"

namespace continuum {

/// A parameter that a fit may change, after those "per log" and "per condition" were multiplied
/// out to one for each log or condition.
struct FreeParameter {
  std::string name;  ///< "mass", "mass[CONDITION]", "mass[LOG]"
  std::string unit;
  double initial, lower, upper;  ///< [unit]
  double scale;                  ///< a typical size [unit], for scaling and finite differences
  Change change;                 ///< what it does to the model; the value is filled in
  std::vector<bool> log;         ///< [log] whether it acts there
  std::string where = {};        ///< file:line: key, for messages
  /// Why a bound is another than was asked for; empty: it is not.
  std::string why_lower = {}, why_upper = {};

  const std::string& WhyNearerBound(double value) const {
    return value - lower < upper - value ? why_lower : why_upper;
  }
  /// Whether it is an initial position or speed of a trial, called "start:JOINT".
  bool IsStart() const { return change.target.starts_with("start:"); }
};

/// How logs are simulated: as MuJoCo steps the model, or as a differential equation by CVODES,
/// whose sensitivities are exact to its tolerance.
enum class Path { kStepped, kSmooth };

}  // namespace continuum
