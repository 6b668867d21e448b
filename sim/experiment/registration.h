#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "sim/simulation/simulate.h"

namespace continuum {

/// The offset of the marker of an output's sensor ("tip_pos" or "tip_pos[1]") [m]; zero without.
Registration::Vector OffsetOf(const Registration& r, const std::string& source);

/// A number of a registration by the name it has as a parameter's attribute (target
/// "registration"): rotation[i], translation[i], marker:SENSOR[i], clock_shift. Throws Error for
/// other names.
double& RegistrationValue(Registration& r, const std::string& attribute);
bool IsRegistration(const std::string& attribute);

/// What a registration leaves to be estimated, as parameters of a fit, from its present values.
std::vector<Parameter> RegistrationParameters(const Experiment& e, const Wiring& wiring,
                                              const mjModel& m);

/// Least squares of what the registration leaves to be estimated, over the train logs; traces: of
/// all logs, as simulated. The frame starts from the closed form (Kabsch) over all positions that
/// are measured in all three directions, so it may be turned by any angle; the clock starts from
/// its present shift.
///
/// Throws Error (kInput) when the logs do not determine it: fewer than three rows, points on a
/// line, a marker that only translates, a part that changes nothing.
Registration Registered(const Experiment& e, const Wiring& wiring, const mjModel& m,
                        const std::vector<Trace>& traces);

/// The experiment with its registration estimated from its train logs as the model simulates them;
/// the same where nothing is to be estimated.
Experiment Registered(const Experiment& e, const ModelSpec& system);

/// Values and units; null when there is no registration.
nlohmann::json RegistrationJson(const Registration& r);
/// One line of text a part.
std::vector<std::string> RegistrationLines(const Registration& r);
/// As the experiment's key, all values known; empty when there is no registration.
std::string RegistrationYaml(const Registration& r);

}  // namespace continuum
