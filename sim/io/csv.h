#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace continuum {

/// A table in a text file: columns by name, cells as text, numbers on demand.
///
/// The character between cells is found by itself (DelimiterOf); cells may be quoted. Blank lines,
/// comments (IsComment), a delimiter at the end of every line and a byte-order mark are skipped.
/// Without a header the columns are named "1", "2", …; a comment just before the rows with as many
/// cells is a header. Numbers have a decimal point, or a decimal comma throughout. Every error
/// names file and line.
class CsvTable {
 public:
  static constexpr double kLargest = 1e100;  ///< the sum of squares of such numbers is finite

  /// Throws Error for a file that is no text, with its format and a line that converts it.
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
  /// As Number, but a cell that is missing (IsMissing) is NaN: a value that was not measured.
  double NumberOrNan(std::size_t row, std::string_view column) const;
  /// true, false or a number (0 is false).
  bool Flag(std::size_t row, std::string_view column) const;
  std::vector<double> Numbers(std::string_view column) const;
  /// A number, as exact as its text, or seconds of a date or time of day (SecondsOfStamp).
  struct Time {
    long double value;
    bool stamp;
  };
  Time TimeAt(std::size_t row, std::string_view column) const;

 private:
  class Reader;

  std::size_t Column(std::string_view column) const;
  /// The cell as a number of C++, without '+' and with a decimal point.
  std::string Plain(const std::string& cell) const;
  /// What a row that is none may be.
  std::string Hint(std::size_t row) const;
  [[noreturn]] void RefuseCell(std::size_t row, std::string_view column,
                               const std::string& expected) const;

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<int> lines_;
  bool numbered_ = false;       ///< no header
  bool decimal_comma_ = false;  ///< of all numbers that have one
};

/// A cell as CSV writes it: in quotes where it has a comma, a quote, a line
/// break, or a blank at an end, or begins like a comment.
std::string CsvCell(const std::string& text);

}  // namespace continuum
