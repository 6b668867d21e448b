#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace continuum {

/// The findings of a row with the command check.
inline constexpr char kFindings[] = "findings.json";

/// A fitted parameter of a row.
struct RowParameter {
  std::string name, unit;
  double value, low, high;  ///< with its 95 % interval; NaN: not known
  bool at_bound;
};

/// What a row found, in the words and numbers of its own files. A number that a command does not
/// have is NaN.
struct RowResult {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string verdict;    ///< diagnose: its own; identify: "converged"; check: "2 warnings"
  std::string certainty;  ///< of a diagnosis: "sure", "likely", "cannot say"
  std::vector<std::string> effects;  ///< causes that were named
  std::string cause;                 ///< the same with their places; check: the first finding
  double gain = kNone, gain_low = kNone, gain_high = kNone;  ///< share of the validate error
  std::string unit;                                          ///< of the errors
  double train = kNone, validate = kNone;  ///< error (a diagnosis: before the extension)
  double validate_after = kNone;           ///< of a diagnosis
  std::vector<RowParameter> parameters;    ///< of identify
  std::string page;                        ///< file in the folder that shows it; may be empty
};

/// Where a command writes what ReadResult reads.
const char* ResultFile(const std::string& command);

/// Reads the files of a row that is done. Throws Error for files that are not what the command
/// writes.
RowResult ReadResult(const std::filesystem::path& folder, const std::string& command);

}  // namespace continuum
