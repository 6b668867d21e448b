#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace continuum {

/// What `continuum solve` was asked to do; empty text or path: not given.
struct SolveRequest {
  std::filesystem::path robot;       ///< the robot's YAML file
  std::filesystem::path input;       ///< CASES.csv
  std::filesystem::path measured;    ///< MEASURED.csv
  std::filesystem::path errors;      ///< table of the distances from `measured`, .csv or .json
  std::filesystem::path boxplot;     ///< picture of these distances, .png, .svg or .pdf
  std::filesystem::path out;         ///< .csv, .json or .yaml, as the job asks
  std::filesystem::path plot;        ///< picture of the shapes, .png, .svg or .pdf
  std::filesystem::path shape;       ///< places along the axes of the solved cases, .csv or .json
  std::filesystem::path outlines;    ///< stiff_flop: deformed sections, .csv, .json or .svg
  std::filesystem::path compliance;  ///< how the tips move by every input, .csv or .json
  std::filesystem::path reach;       ///< TARGETS.csv: where tips or disks of the cases should be
  std::filesystem::path follow;      ///< PATH.csv: what the whole robot should lie on
  std::string method;
  std::string hybrid;  ///< train or apply
  bool calibrate = false;
  std::vector<std::string> parameters;  ///< of --calibrate: what to find; empty: the usual ones
  bool cross_validate = false;  ///< tdcr: choose the training's penalty, as without `lambda`
  bool sensitivity = false;
  int sweep = 0;  ///< values of every column that differs in the two rows of `input`; 0: its rows
  bool equilibria = false;  ///< all of every case that a search finds, a row each
  /// A table instead of the file `input`, and where its results go instead of `out` (as CSV): a row
  /// of a stream.
  std::string row;
  std::function<void(const std::string&)> take = nullptr;
  /// Called for what was not used: a sentence with file and line.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  /// Called with a sentence about the results.
  std::function<void(const std::string&)> say = [](const std::string&) {};
  std::optional<double> lambda;  ///< tdcr: penalty of the fit or of the hybrid's training
};

}  // namespace continuum
