#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace continuum {

/// What `continuum solve` was asked to do; empty text or path: not given.
struct SolveRequest {
  std::filesystem::path robot;     ///< the robot's YAML file
  std::filesystem::path input;     ///< CASES.csv
  std::filesystem::path measured;  ///< MEASURED.csv
  std::filesystem::path out;       ///< .csv, .json or .yaml, as the job asks
  std::filesystem::path plot;      ///< picture of the shapes, .png, .svg or .pdf
  std::filesystem::path shape;     ///< places along the axes of the solved cases, .csv or .json
  std::string method;
  std::string hybrid;  ///< train or apply
  bool calibrate = false;
  bool cross_validate = false;  ///< tdcr: choose the training's penalty
  bool sensitivity = false;
  bool equilibria = false;  ///< all of every case that a search finds, a row each
  /// Called for what was not used: a sentence with file and line.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  std::optional<double> lambda;  ///< tdcr: penalty of the fit or of the hybrid's training
};

}  // namespace continuum
