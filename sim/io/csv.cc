#include "sim/io/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "error.h"
#include "sim/io/excerpt.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

constexpr std::size_t kColumnListLength = 500;  // characters of a list of columns

std::string_view Trim(std::string_view s) {
  const auto blank = " \t\r";
  const auto first = s.find_first_not_of(blank);
  if (first == s.npos) return {};
  return s.substr(first, s.find_last_not_of(blank) - first + 1);
}

// One line of CSV; a quoted cell may hold commas and doubled quotes, but no line break.
std::vector<std::string> Split(std::string_view line, const std::string& where) {
  std::vector<std::string> cells;
  std::size_t i = 0;
  while (true) {
    while (i < line.size() && (line[i] == ' ' || line[i] == '\t')) ++i;
    std::string cell;
    if (i < line.size() && line[i] == '"') {
      for (++i;; ++i) {
        if (i == line.size()) throw Error::Input(where, "a closing quote", "the end of the line");
        if (line[i] != '"') {
          cell += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          cell += line[i++];
        } else {
          break;
        }
      }
      const std::size_t comma = std::min(line.find(',', i), line.size());
      if (!Trim(line.substr(i + 1, comma - i - 1)).empty()) {
        throw Error::Input(where, "a comma after a quoted cell",
                           "'" + std::string(Trim(line.substr(i + 1, comma - i - 1))) + "'");
      }
      i = comma;
    } else {
      const std::size_t comma = std::min(line.find(',', i), line.size());
      cell = Trim(line.substr(i, comma - i));
      i = comma;
    }
    cells.push_back(std::move(cell));
    if (i >= line.size()) return cells;
    ++i;
  }
}

}  // namespace

CsvTable CsvTable::Read(const std::filesystem::path& file) {
  return Parse(ReadFile(file), file.string());
}

CsvTable CsvTable::Parse(std::string_view text, std::string name) {
  CsvTable t;
  t.name_ = std::move(name);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.find('\0') != text.npos) throw Error::Input(t.name_, "a text file", "a zero byte");
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view row = Trim(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.empty()) continue;
    const std::string where = t.name_ + ":" + std::to_string(line);
    auto cells = Split(row, where);
    if (t.columns_.empty()) {
      t.columns_ = std::move(cells);
      std::set<std::string_view> names;
      for (const std::string& name : t.columns_) {
        if (name.empty()) throw Error::Input(where, "a name for every column", "an empty one");
        if (!names.insert(name).second) {
          throw Error::Input(where, "different column names", "'" + Excerpt(name) + "' twice");
        }
      }
    } else if (cells.size() != t.columns_.size()) {
      throw Error::Input(where, std::to_string(t.columns_.size()) + " cells as in the header",
                         std::to_string(cells.size()));
    } else {
      t.cells_.push_back(std::move(cells));
      t.lines_.push_back(line);
    }
  }
  if (t.columns_.empty()) throw Error::Input(t.name_, "a header line", "an empty file");
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
  throw Error::Input(name_ + ":1", "a column '" + std::string(column) + "'",
                     Excerpt(all, kColumnListLength));
}

std::string CsvTable::Where(std::size_t row) const {
  return name_ + ":" + std::to_string(lines_.at(row));
}

const std::string& CsvTable::Text(std::size_t row, std::string_view column) const {
  return cells_.at(row)[Column(column)];
}

double CsvTable::NumberOrNan(std::size_t row, std::string_view column) const {
  const std::string& cell = Text(row, column);
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return Number(row, column);
}

double CsvTable::Number(std::size_t row, std::string_view column) const {
  const std::string& cell = Text(row, column);
  const bool plus = cell.starts_with('+') && !cell.starts_with("+-");
  const char* const begin = cell.data() + (plus ? 1 : 0);
  const char* const end = cell.data() + cell.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  const bool read = error == std::errc{} && stop == end && std::isfinite(value);
  if (read && std::abs(value) <= kLargest) return value;
  throw Error::Input(Where(row) + ", column '" + std::string(column) + "'",
                     read ? "a number within +-1e100" : "a finite number",
                     cell.empty() ? "an empty cell" : "'" + Excerpt(cell) + "'");
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
  const bool plain = text.find_first_of(",\"\r\n") == text.npos;
  if (plain && (text.empty() || (text.front() != ' ' && text.back() != ' '))) return text;
  std::string quoted;
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return "\"" + quoted + "\"";
}

}  // namespace continuum
