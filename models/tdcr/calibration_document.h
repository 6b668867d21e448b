#pragma once

#include <optional>
#include <string>

#include <yaml-cpp/yaml.h>

#include "models/tdcr/calibrate.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {

/// The robot's file with the values found and a map `calibration` that says how well. `source`
/// stands beside every value that has a map of its own.
YAML::Node CalibrationDocument(const Yaml& file, const Robot& nominal, const std::string& method,
                               const Calibration& calibration, const std::string& source);

/// Adds status, rmse, deflection and scatter.
void AddExplained(const Explained& explained, bool poor, YAML::Node& node);

/// `calibration: prediction` of a robot's file, where it has one. @throws Error with file, line and
/// key.
std::optional<Prediction> ReadPrediction(const Yaml& file, const Robot& robot);

}  // namespace continuum::tdcr
