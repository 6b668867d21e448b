#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace continuum {

/// A CSV file with a header row: columns by name, cells as text, numbers on demand.
///
/// Comma-separated; cells may be quoted; blank lines and a byte-order mark are skipped. Every error
/// names file and line.
class CsvTable {
 public:
  static constexpr double kLargest = 1e100;  ///< the sum of squares of such numbers is finite

  static CsvTable Read(const std::filesystem::path& file);
  /// name stands for the file in messages.
  static CsvTable Parse(std::string_view text, std::string name);

  const std::string& name() const { return name_; }
  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t rows() const { return cells_.size(); }
  bool Has(std::string_view column) const;
  /// Throws Error when there is only a header.
  void RequireRows() const;

  /// "file:line" of a row, for messages.
  std::string Where(std::size_t row) const;
  /// Throws Error when there is no such column.
  const std::string& Text(std::size_t row, std::string_view column) const;
  /// A number of at most kLargest in size; throws Error (file:line, column, cell) otherwise.
  double Number(std::size_t row, std::string_view column) const;
  /// As Number, but an empty cell or "nan" is NaN: a value that was not measured.
  double NumberOrNan(std::size_t row, std::string_view column) const;
  /// true, false or a number (0 is false).
  bool Flag(std::size_t row, std::string_view column) const;
  std::vector<double> Numbers(std::string_view column) const;

 private:
  std::size_t Column(std::string_view column) const;

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<int> lines_;
};

/// A cell as CSV writes it: in quotes where it has a comma, a quote, a line
/// break, or a blank at an end.
std::string CsvCell(const std::string& text);

}  // namespace continuum
