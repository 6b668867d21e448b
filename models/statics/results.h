#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "models/statics/rising_load.h"
#include "models/statics/solve_request.h"
#include "sim/numerics/solver.h"

namespace continuum::statics {

/// A table of results with named columns, written as CSV or as a JSON array of objects.
///
/// A cell is a text, a number (17 significant digits at most, the shortest that read back exactly)
/// or nothing (a case that failed: empty in CSV, null in JSON). Numbers that are not finite are
/// written as nothing.
class Results {
 public:
  using Cell = std::variant<std::monostate, std::string, double, int>;

  explicit Results(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t rows() const { return cells_.size(); }

  /// Starts the next row, all cells empty.
  void Row() { cells_.emplace_back(columns_.size()); }
  /// Sets a cell of the last row. @throws Error when there is no such column (a mistake in a
  /// model).
  void Set(const std::string& column, Cell cell);
  /// Sets `status`, `iterations`, `residual` and `micros`, those of them that are columns.
  void Set(const numerics::Outcome& outcome, const std::string& status);
  /// Sets StabilityColumns(): of a case that failed `why` alone.
  void Set(const numerics::Outcome& outcome, const Stability& stability);

  std::string Csv() const;
  std::string Json() const;
  /// By extension: .csv or .json, the whole file or nothing. @throws Error for another extension.
  void Write(const std::filesystem::path& path) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> cells_;
};

/// Writes results where a request asks for them: to its file, or as a row of a stream.
void Write(const Results& results, const SolveRequest& request);

/// ok, no_convergence, or saddle of an unstable equilibrium in a list of them.
std::string StatusOf(const numerics::Outcome& outcome, const Stability& stability);

/// `stable` (1 or 0), `unstable_directions`, `branch` and `why` (empty when ok) of a solved case.
std::vector<std::string> StabilityColumns();

/// The names `prefix1`, `prefix2`, .. `prefix<count>` that the contracts use for numbered columns.
std::vector<std::string> Numbered(const std::string& prefix, int count);

/// @throws Error when path does not end in one of the extensions (".csv", ".json", ..): called
/// before the work, so that a wrong name costs nothing.
void RequireExtension(const std::filesystem::path& path, const std::vector<std::string>& allowed,
                      const std::string& option);
/// The same of a table that is asked for: .csv or .json; an empty path is none.
void RequireTable(const std::filesystem::path& path, const std::string& option);

}  // namespace continuum::statics
