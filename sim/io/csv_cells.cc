#include "sim/io/csv_cells.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "error.h"
#include "sim/io/time_stamp.h"

namespace continuum {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

const char* NameOf(char delimiter) {
  switch (delimiter) {
    case ';':
      return "a semicolon";
    case '\t':
      return "a tab";
    case '|':
      return "a bar";
    case ' ':
      return "a blank";
    default:
      return "a comma";
  }
}

// Cuts one line into cells.
class Cutter {
 public:
  Cutter(std::string_view line, char delimiter, const std::string& where)
      : line_(line), delimiter_(delimiter), where_(where) {}

  std::vector<std::string> Run() {
    if (delimiter_ == ' ') line_ = TrimBlanks(line_);
    std::vector<std::string> cells;
    while (true) {
      while (at_ < line_.size() && IsBlank(line_[at_]) && line_[at_] != delimiter_) ++at_;
      cells.push_back(at_ < line_.size() && line_[at_] == '"' ? Quoted() : Plain());
      if (at_ >= line_.size()) return cells;
      ++at_;
      while (delimiter_ == ' ' && at_ < line_.size() && IsBlank(line_[at_])) ++at_;
    }
  }

 private:
  std::size_t NextDelimiter() const {
    const std::size_t end =
        delimiter_ == ' ' ? line_.find_first_of(" \t", at_) : line_.find(delimiter_, at_);
    return std::min(end, line_.size());
  }

  std::string Plain() {
    const std::size_t end = NextDelimiter();
    const std::string cell(TrimBlanks(line_.substr(at_, end - at_)));
    at_ = end;
    return cell;
  }

  std::string Quoted() {
    std::string cell;
    for (++at_;; ++at_) {
      if (at_ == line_.size()) throw Error::Input(where_, "a closing quote", "the end of the line");
      if (line_[at_] != '"') {
        cell += line_[at_];
      } else if (at_ + 1 < line_.size() && line_[at_ + 1] == '"') {
        cell += line_[at_++];
      } else {
        break;
      }
    }
    ++at_;
    const std::size_t end = NextDelimiter();
    const std::string_view rest = TrimBlanks(line_.substr(at_, end - at_));
    if (!rest.empty()) {
      throw Error::Input(where_, std::string(NameOf(delimiter_)) + " after a quoted cell",
                         "'" + std::string(rest) + "'");
    }
    at_ = end;
    return cell;
  }

  std::string_view line_;
  char delimiter_;
  const std::string& where_;
  std::size_t at_ = 0;
};

// How well a delimiter fits a table.
struct Fit {
  std::size_t cells = 1;  // of the first line
  double score = 0;
};

// Cells without the empty one that a delimiter at the end of a line makes.
std::vector<std::string> CellsForSniffing(std::string_view line, char delimiter) {
  try {
    std::vector<std::string> cells = SplitCells(line, delimiter, "");
    if (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
  } catch (const Error&) {
    return {};
  }
}

Fit FitOf(const std::vector<std::string_view>& lines, char delimiter) {
  Fit fit{CellsForSniffing(lines.front(), delimiter).size(), 0};
  double alike = 0, numbers = 0, filled = 0;
  for (std::size_t i = lines.size() > 1; i < lines.size(); ++i) {
    const auto cells = CellsForSniffing(lines[i], delimiter);
    // An empty last value; none is empty between runs of blanks.
    const bool trailing = delimiter != ' ' && cells.size() + 1 == fit.cells;
    alike += cells.size() == fit.cells || trailing;
    for (const std::string& cell : cells) {
      filled += !IsMissing(cell);
      numbers += IsNumber(cell) || SecondsOfStamp(cell).has_value();
    }
  }
  alike /= static_cast<double>(std::max<std::size_t>(1, lines.size() - 1));
  fit.score = alike < 0.5 ? 0 : alike * (1 + (filled > 0 ? numbers / filled : 0));
  return fit;
}

}  // namespace

std::string_view TrimBlanks(std::string_view text) {
  const auto blank = " \t\r";
  const auto first = text.find_first_not_of(blank);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

bool IsComment(std::string_view line) {
  const std::string_view text = TrimBlanks(line);
  return text.starts_with('#') || text.starts_with('%') || text.starts_with("//") ||
         (text.starts_with("sep=") && text.size() <= 5);
}

bool IsMissing(std::string_view cell) {
  static constexpr std::array<std::string_view, 24> kWords{
      "",        "nan",   "na",      "n/a",      "#n/a",      "#na",     "<na>",     "null",
      "none",    "nat",   "-nan",    "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#qnan", "1.#ind",
      "-1.#ind", "#num!", "#div/0!", "#value!",  "-",         "--",      "---",      "?"};
  std::string lower(cell);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

bool IsNumber(std::string_view cell) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  std::string point(cell);
  const std::size_t comma = point.find(',');
  if (comma != point.npos && point.find('.') == point.npos) {
    if (comma + 1 == point.size() || !IsDigit(point[comma + 1])) return false;
    point[comma] = '.';
  }
  double value = 0;
  const char* const end = point.data() + point.size();
  const auto [stop, error] = std::from_chars(point.data(), end, value);
  const bool word = std::none_of(point.begin(), point.end(), IsDigit);  // "inf"
  return error != std::errc::invalid_argument && stop == end && !word;
}

bool HasDecimalComma(std::string_view cell) {
  return cell.find(',') != cell.npos && IsNumber(cell);
}

std::vector<std::string> SplitCells(std::string_view line, char delimiter,
                                    const std::string& where) {
  return Cutter(line, delimiter, where).Run();
}

char DelimiterOf(const std::vector<std::string_view>& lines) {
  if (lines.empty()) return ',';
  char best = ',';
  double score = FitOf(lines, ',').cells > 1 ? FitOf(lines, ',').score : 0;
  for (const char delimiter : {';', '\t', '|', ' '}) {
    const Fit fit = FitOf(lines, delimiter);
    // A name alone on its line may have blanks.
    if (fit.cells < 2 || (delimiter == ' ' && lines.size() < 2)) continue;
    if (fit.score > score) best = delimiter, score = fit.score;
  }
  return best;
}

}  // namespace continuum
