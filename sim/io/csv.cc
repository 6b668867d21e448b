#include "sim/io/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "error.h"
#include "sim/io/csv_cells.h"
#include "sim/io/excerpt.h"
#include "sim/io/file.h"
#include "sim/io/file_format.h"
#include "sim/io/time_stamp.h"

namespace continuum {
namespace {

constexpr std::size_t kColumnListLength = 500;  // characters of a list of columns

constexpr std::size_t kSniffed = 50;  // lines that show the delimiter

// Whether a first line holds values and no names. Whole numbers that count up are names.
bool IsRow(const std::vector<std::string>& cells) {
  const auto value = [](const std::string& c) {
    return IsMissing(c) || IsNumber(c) || SecondsOfStamp(c).has_value();
  };
  if (!std::all_of(cells.begin(), cells.end(), value) ||
      std::none_of(cells.begin(), cells.end(), IsNumber))
    return false;
  for (const int from : {0, 1}) {
    bool counts = cells.size() >= 3;
    for (std::size_t i = 0; i < cells.size(); ++i)
      counts = counts && cells[i] == std::to_string(i + static_cast<std::size_t>(from));
    if (counts) return false;
  }
  return true;
}

}  // namespace

// Reads a text into a table.
class CsvTable::Reader {
 public:
  Reader(CsvTable& table, std::string_view text) : table_(table) {
    // Some programs end lines with a carriage return alone.
    const char line_end = text.find('\n') == text.npos ? '\r' : '\n';
    for (int line = 1; !text.empty(); ++line) {
      const std::size_t end = std::min(text.find(line_end), text.size());
      const std::string_view row = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      if (TrimBlanks(row).empty()) continue;
      if (!IsComment(row)) {
        lines_.emplace_back(row, line);
      } else if (lines_.empty()) {
        comment_ = TrimBlanks(row);
      }
    }
  }

  void Run() {
    if (lines_.empty()) throw Error::Input(table_.name_, "a header line", "an empty file");
    std::vector<std::string_view> sample;
    for (std::size_t i = 0; i < std::min(lines_.size(), kSniffed); ++i)
      sample.push_back(lines_[i].first);
    delimiter_ = DelimiterOf(sample);
    const std::size_t first = ReadHeader();
    for (std::size_t i = first; i < lines_.size(); ++i) ReadRow(lines_[i].first, lines_[i].second);
    FindDecimalComma();
  }

 private:
  std::string Where(int line) const { return table_.name_ + ":" + std::to_string(line); }

  // Returns the first line that is no header.
  std::size_t ReadHeader() {
    auto& names = table_.columns_;
    const auto [line, number] = lines_.front();
    names = SplitCells(line, delimiter_, Where(number));
    if (!IsRow(names)) {
      if (names.size() > 1 && names.back().empty()) names.pop_back();
      NumberNameless();
      CheckNames(Where(number));
      return 1;
    }
    const std::size_t count = names.size() - (names.size() > 1 && names.back().empty());
    names = CommentedNames();
    if (names.size() != count || IsRow(names)) {
      names.clear();
      for (std::size_t i = 1; i <= count; ++i) names.push_back(std::to_string(i));
      table_.numbered_ = true;
    }
    CheckNames(table_.name_);
    return 0;
  }

  // "# t, x" just before the rows.
  std::vector<std::string> CommentedNames() const {
    const std::size_t begin = comment_.find_first_not_of("#%/");
    if (begin == comment_.npos) return {};
    try {
      return SplitCells(TrimBlanks(comment_.substr(begin)), delimiter_, "");
    } catch (const Error&) {
      return {};
    }
  }

  // A column without a name, as the index that pandas writes first, is called by its number.
  void NumberNameless() {
    auto& names = table_.columns_;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].empty()) names[i] = std::to_string(i + 1);
    }
  }

  void CheckNames(const std::string& where) const {
    std::set<std::string_view> names;
    for (const std::string& name : table_.columns_) {
      if (!names.insert(name).second) {
        throw Error::Input(where, "different column names", "'" + Excerpt(name) + "' twice");
      }
    }
  }

  void ReadRow(std::string_view line, int number) {
    const std::size_t expected = table_.columns_.size();
    auto cells = SplitCells(line, delimiter_, Where(number));
    if (cells.size() == expected + 1 && cells.back().empty()) cells.pop_back();
    if (cells.size() != expected) RefuseRow(cells.size(), number);
    table_.cells_.push_back(std::move(cells));
    table_.lines_.push_back(number);
  }

  [[noreturn]] void RefuseRow(std::size_t found, int number) const {
    const std::size_t expected = table_.columns_.size();
    const bool commas = delimiter_ == ',' && found == 2 * expected;
    const bool cut = found < expected && number == lines_.back().second;
    const bool preface = lines_.size() > 2 && CellsOf(lines_.back()) == found;
    throw Error::Input(
        Where(number),
        std::to_string(expected) +
            (table_.numbered_ ? " cells as in the first row" : " cells as in the header"),
        std::to_string(found) + (commas ? " (decimal commas? Then put ';' between cells)"
                                 : cut  ? " in the last line (cut off? Then delete it)"
                                 : preface
                                     ? ", as in the last line (are the first lines no table? Put # "
                                       "before them)"
                                     : ""));
  }

  std::size_t CellsOf(const std::pair<std::string_view, int>& line) const {
    return SplitCells(line.first, delimiter_, Where(line.second)).size();
  }

  void FindDecimalComma() {
    bool comma = false, point = false;
    for (const auto& row : table_.cells_) {
      for (const std::string& cell : row) {
        if (cell.find_first_of(",.") == cell.npos) continue;
        comma = comma || HasDecimalComma(cell);
        point = point || (cell.find('.') != cell.npos && IsNumber(cell));
      }
    }
    table_.decimal_comma_ = comma && !point;
  }

  CsvTable& table_;
  std::vector<std::pair<std::string_view, int>> lines_;  // with their numbers, no comments
  std::string_view comment_;                             // the last before the table
  char delimiter_ = ',';
};

CsvTable CsvTable::Read(const std::filesystem::path& file) {
  const std::string text = ReadFile(file);
  RequireText(text, file);
  return Parse(text, file.string());
}

CsvTable CsvTable::Parse(std::string_view text, std::string name) {
  CsvTable t;
  t.name_ = std::move(name);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.find('\0') != text.npos) throw Error::Input(t.name_, "a text file", "a zero byte");
  Reader(t, text).Run();
  return t;
}

bool CsvTable::Has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

void CsvTable::RequireRows() const {
  if (rows() == 0) throw Error::Input(name_, "one row or more", "only a header");
}

std::size_t CsvTable::Column(std::string_view column) const {
  const auto c = std::find(columns_.begin(), columns_.end(), column);
  if (c != columns_.end()) return static_cast<std::size_t>(c - columns_.begin());
  std::string all;
  for (const auto& name : columns_) all += (all.empty() ? "" : ", ") + name;
  all = Excerpt(all, kColumnListLength);
  if (numbered_) all += " (the file has no header: its columns are numbered, as in `column: 1`)";
  throw Error::Input(name_ + ":1", "a column '" + std::string(column) + "'", all);
}

std::string CsvTable::Where(std::size_t row) const {
  return name_ + ":" + std::to_string(lines_.at(row));
}

const std::string& CsvTable::Text(std::size_t row, std::string_view column) const {
  return cells_.at(row)[Column(column)];
}

double CsvTable::NumberOrNan(std::size_t row, std::string_view column) const {
  if (IsMissing(Text(row, column))) return std::numeric_limits<double>::quiet_NaN();
  return Number(row, column);
}

std::string CsvTable::Plain(const std::string& cell) const {
  std::string plain = cell.starts_with('+') && !cell.starts_with("+-") ? cell.substr(1) : cell;
  if (decimal_comma_ && plain.find('.') == plain.npos && HasDecimalComma(plain))
    plain[plain.find(',')] = '.';
  return plain;
}

double CsvTable::Number(std::size_t row, std::string_view column) const {
  const std::string cell = Plain(Text(row, column));
  double value = 0;
  const char* const end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  const bool read = error == std::errc{} && stop == end && std::isfinite(value);
  if (read && std::abs(value) <= kLargest) return value;
  RefuseCell(row, column, read ? "a number within +-1e100" : "a finite number");
}

// Lines that some programs write among the numbers.
std::string CsvTable::Hint(std::size_t row) const {
  const auto& cells = cells_.at(row);
  if (cells == columns_) return " (the header again? Delete this line)";
  const bool words = std::none_of(cells.begin(), cells.end(), IsNumber);
  return row == 0 && words ? " (a line of units? Put # before it)" : "";
}

void CsvTable::RefuseCell(std::size_t row, std::string_view column,
                          const std::string& expected) const {
  const std::string& cell = Text(row, column);
  const bool comma = !decimal_comma_ && HasDecimalComma(cell);
  throw Error::Input(Where(row) + ", column '" + std::string(column) + "'",
                     expected + (comma ? " with a decimal point, as elsewhere in the file" : ""),
                     (cell.empty() ? "an empty cell" : "'" + Excerpt(cell) + "'") + Hint(row));
}

CsvTable::Time CsvTable::TimeAt(std::size_t row, std::string_view column) const {
  const std::string& cell = Text(row, column);
  if (const auto stamp = SecondsOfStamp(cell)) return {*stamp, true};
  if (IsNumber(cell) && std::abs(Number(row, column)) <= kLargest) {
    const std::string plain = Plain(cell);
    long double value = 0;
    std::from_chars(plain.data(), plain.data() + plain.size(), value);
    return {value, false};
  }
  const bool date = cell.find_first_of(":/") != cell.npos;
  RefuseCell(row, column,
             date ? "a time like 2024-05-01T12:00:00.01 or a number" : "a finite number");
}

bool CsvTable::Flag(std::size_t row, std::string_view column) const {
  const std::string& cell = Text(row, column);
  if (cell == "True" || cell == "true" || cell == "TRUE") return true;
  if (cell == "False" || cell == "false" || cell == "FALSE") return false;
  return Number(row, column) != 0;
}

std::vector<double> CsvTable::Numbers(std::string_view column) const {
  std::vector<double> values(rows());
  for (std::size_t i = 0; i < rows(); ++i) values[i] = Number(i, column);
  return values;
}

std::string CsvCell(const std::string& text) {
  const bool plain = text.find_first_of(",\"\r\n") == text.npos && !IsComment(text);
  if (plain && (text.empty() || (text.front() != ' ' && text.back() != ' '))) return text;
  std::string quoted;
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return "\"" + quoted + "\"";
}

}  // namespace continuum
