#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "models/statics/solve_request.h"

namespace continuum::statics {

/// Options, or several of them together, that a robot does not have, and whether they were given.
using ForeignOptions = std::initializer_list<std::pair<const char*, bool>>;

/// Refuses the first of them that was given. @throws Error with the option and the robot's name.
void RefuseGiven(const std::string& robot, const ForeignOptions& options);

/// The same of all robots with files of parameters: `foreign`, what no robot does together (outputs
/// and targets with --calibrate, --equilibria with --reach or --measured), and a request without
/// cases.
/// @throws Error with the option and the robot's name.
void RefuseForeignOptions(const SolveRequest& request, const std::string& robot,
                          const ForeignOptions& foreign);

}  // namespace continuum::statics
