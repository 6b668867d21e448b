#pragma once

#include <string>

#include "models/statics/solve_request.h"

namespace continuum::statics {

/// Warns when |value| is not within low..high, with the value and that range: a value in
/// millimetres, degrees or grams is far from any robot that the model is made for. 0 is never
/// implausible.
void WarnIfImplausible(const SolveRequest& request, const std::string& where, double value,
                       double low, double high, const std::string& unit);

/// Warns of an angle that must be one in degrees: more than a whole turn.
void WarnIfDegrees(const SolveRequest& request, const std::string& where, double angle);

}  // namespace continuum::statics
