#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "models/statics/canvas.h"
#include "models/statics/solve_request.h"

namespace continuum::statics {

/// How far a model is from measured points: distances of disks over cases, those of `test` apart.
///
/// Of a set of distances e: mae = mean e [m], mape = 100 mae/length [%], std (of a sample), min,
/// the quartiles q1, median, q3, and max [m].
class ErrorTable {
 public:
  /// length: of the robot [m]; disks: the last one is the tip.
  ErrorTable(double length, int disks);

  /// Distances of one case [m]; NaN: not measured.
  void Add(bool test, const Eigen::VectorXd& distances);

  bool empty() const { return rows() == 0; }
  /// Of both sets and all disks.
  std::size_t rows() const;
  /// mae, mape and the largest of the tip, or of all disks where no tip was measured.
  std::string Sentence() const;
  /// Rows by `set` (train, test) and `disk` (1.., then `all`). .csv or .json.
  void Write(const std::filesystem::path& path) const;
  /// A box for every disk and set: quartiles, median, mean (cross); whiskers to the farthest value
  /// within 1.5 times the box, dots beyond (Tukey). .png, .svg or .pdf.
  void Draw(const std::filesystem::path& path, const std::string& title) const;

 private:
  void DrawBoxes(const std::string& title, Canvas& canvas) const;

  double length_;
  std::vector<std::vector<double>> distances_[2];  ///< train, test: by disk
};

/// @throws Error for --errors or --boxplot without --measured or with another ending.
void CheckErrorOptions(const SolveRequest& request);

/// Says the sentence and writes what the request asks for.
void ReportErrors(const SolveRequest& request, const ErrorTable& errors, const std::string& title);

}  // namespace continuum::statics
