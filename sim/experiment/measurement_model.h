#pragma once

#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/model/change.h"

namespace continuum {

/// Whether a change is one of how channels are measured instead of the model: target "sensor:GLOB
/// …" (of sensors, actuators or columns of outputs) with an attribute of Measurement, target
/// "time" with skew, or target "registration" (sim/experiment/registration.h).
bool IsMeasurement(const std::string& target, const std::string& attribute);

/// The value that such a change would replace, of the first output that matches. Throws Error when
/// none does.
double MeasurementValue(const Experiment& e, const std::string& target,
                        const std::string& attribute);

/// What a channel measures in a row stands for in the model [SI]: without its scale, bias, drift
/// and eccentricity.
double SignalOf(const Experiment& e, const Log& log, std::size_t channel, std::size_t row);
std::vector<double> SignalsOf(const Experiment& e, const Log& log, std::size_t channel);

/// Changes the outputs (or the skew) of an experiment; its logs stay as they are.
void ApplyMeasurement(Experiment& e, const Change& change);

/// What a log sets of the model: all of its `set` but how it was measured.
std::vector<Change> SettingsOfModel(const Log& log);

/// How an experiment is set up.
Experiment WithoutLogs(const Experiment& e);

/// The experiment as a log was measured, which its `set` may say.
Experiment MeasuredIn(const Experiment& e, const Log& log);

/// The unit of a measurement attribute: that of the outputs that match, or "1" when they differ.
std::string MeasurementUnit(const Experiment& e, const std::string& target,
                            const std::string& attribute);

}  // namespace continuum
