#include "sim/experiment/log_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "effects/effect.h"
#include "error.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"
#include "sim/io/file_format.h"
#include "sim/io/mat_file.h"
#include "sim/io/units.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

// The numbers of a log's file, whatever its format.
class Recording {
 public:
  Recording(const std::filesystem::path& file, const std::string& variable) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".mat" || IsMat(file)) {
      mat_ = ReadMat(file, variable);
    } else {
      table_ = CsvTable::Read(file);
    }
    name_ = file.string();
  }

  std::size_t rows() const { return table_ ? table_->rows() : mat_->values.front().size(); }
  std::string Where(std::size_t row) const {
    return table_ ? table_->Where(row) : name_ + ", row " + std::to_string(row + 1);
  }
  bool Flag(std::size_t row, const std::string& column) const {
    return table_ ? table_->Flag(row, column) : Number(row, column, false) != 0;
  }
  double Number(std::size_t row, const std::string& column, bool may_miss) const {
    if (table_) return may_miss ? table_->NumberOrNan(row, column) : table_->Number(row, column);
    const auto found = std::find(mat_->names.begin(), mat_->names.end(), column);
    if (found == mat_->names.end()) {
      std::string all;
      for (const auto& name : mat_->names) all += (all.empty() ? "" : ", ") + name;
      throw Error::Input(name_, "a column '" + column + "'", all);
    }
    const double value = mat_->values[found - mat_->names.begin()][row];
    if (std::abs(value) <= CsvTable::kLargest || (may_miss && std::isnan(value))) return value;
    throw Error::Input(Where(row) + ", column '" + column + "'", "a number within +-1e100",
                       std::isnan(value) ? "none" : Decimal(value));
  }
  // What stands where a number is missing.
  std::string Missing(std::size_t row, const std::string& column) const {
    const std::string cell = table_ ? table_->Text(row, column) : "";
    return cell.empty() ? "an empty cell" : "'" + cell + "'";
  }
  CsvTable::Time Time(std::size_t row, const std::string& column) const {
    if (table_) return table_->TimeAt(row, column);
    return {Number(row, column, false), false};
  }

 private:
  std::optional<CsvTable> table_;
  std::optional<Columns> mat_;
  std::string name_;
};

std::string Listed(const std::vector<double>& numbers) {
  std::string text = "[";
  for (const double x : numbers) text += (text.size() > 1 ? ", " : "") + Decimal(x);
  return text + "]";
}

std::map<std::string, std::array<double, 2>> ReadStart(const Yaml& y) {
  std::map<std::string, std::array<double, 2>> start;
  for (const auto& joint : y.Keys()) {
    const auto numbers = y.At(joint).Numbers();
    if (numbers.size() != 2)
      throw Error::Input(y.At(joint).Where(), "[position, speed]", Listed(numbers));
    start[joint] = {numbers[0], numbers[1]};
  }
  return start;
}

// The clock of a log. One that counts from long ago (dates, seconds since 1970) is read from its
// first row on, to the nanosecond: the numbers that stay are short.
class LogClock {
 public:
  LogClock(const Experiment& e, const Recording& rec, double unit) : e_(e), rec_(rec), unit_(unit) {
    if (rec.rows() == 0) return;
    const CsvTable::Time first = rec.Time(0, e.time_column);
    stamps_ = first.stamp;
    const auto seconds = stamps_ ? first.value : first.value * unit;
    if (std::abs(seconds) > kLongestTime) RefuseUnit(first.value);
    if (stamps_ || std::abs(seconds) >= kLongAgo) origin_ = first.value;
  }

  /// [s] of the log.
  double At(std::size_t row) const {
    const CsvTable::Time time = rec_.Time(row, e_.time_column);
    if (time.stamp != stamps_) {
      throw Error::Input(Where(row), stamps_ ? "a date or time of day" : "a number",
                         "the other, unlike the first row");
    }
    if (!origin_) return rec_.Number(row, e_.time_column, false) * unit_;
    long double passed = (time.value - *origin_) * (stamps_ ? 1 : unit_);
    if (OverMidnight(passed, time)) passed += kDay;
    return static_cast<double>(std::round(passed * 1e9L) / 1e9L);
  }

  /// The time as messages give it: as the column has it, or in seconds from the first row on.
  std::string Shown(std::size_t row) const {
    return origin_ ? Decimal(At(row)) + " s" : Decimal(rec_.Number(row, e_.time_column, false));
  }

  /// A window's end, which may be a number of such a clock itself.
  double Window(double end) const {
    const bool own = origin_ && !stamps_ && std::abs(end) >= kLongAgo;
    return own ? static_cast<double>(end - *origin_ * unit_) : end;
  }

  std::string Where(std::size_t row) const {
    return rec_.Where(row) + ", column '" + e_.time_column + "'";
  }

 private:
  static constexpr double kLongAgo = 1e8;       // [s], three years
  static constexpr double kLongestTime = 1e11;  // [s], three thousand years

  static constexpr double kDay = 86400;  // [s]

  // Times of day begin anew at midnight.
  bool OverMidnight(long double passed, const CsvTable::Time& time) const {
    return stamps_ && time.value < kDay && passed < -kDay / 2;
  }

  [[noreturn]] void RefuseUnit(long double first) const {
    const double size = static_cast<double>(std::abs(first));
    const std::string unit = size < 1e14 ? "ms" : size < 1e17 ? "us" : "ns";
    throw Error::Input(Where(0), "a time in " + e_.time_unit,
                       Decimal(static_cast<double>(first)) + "; are these " + unit +
                           " since 1970? Then write time: {unit: " + unit + "}");
  }

  const Experiment& e_;
  const Recording& rec_;
  double unit_;
  bool stamps_ = false;
  std::optional<long double> origin_;  // as the column has it
};

// Rows that were written twice are the usual cause.
Error TimeGoesBack(const LogClock& clock, const Recording& rec, std::size_t row) {
  const double now = clock.At(row);
  std::string found = clock.Shown(row) + " after " + clock.Shown(row - 1);
  for (std::size_t k = 0; k < row; ++k) {
    if (clock.At(k) != now) continue;
    found += ", as in " + rec.Where(k) + ": are rows there twice?";
    break;
  }
  return Error::Input(clock.Where(row), "increasing time", found);
}

// Reads the times, of the rows within the log's window; returns these rows.
std::vector<std::size_t> ReadTimes(Log& log, const Experiment& e, const Recording& rec,
                                   double time_unit) {
  const LogClock clock(e, rec, time_unit);
  std::vector<double> window = log.window;
  for (double& end : window) end = clock.Window(end);
  double last = -kInfinity;
  std::vector<std::size_t> kept;
  for (std::size_t row = 0; row < rec.rows(); ++row) {
    const double t = clock.At(row);
    if (!(t > last)) throw TimeGoesBack(clock, rec, row);
    last = t;
    if (row == 0) log.begin = t * (1 + e.skew);
    if (!window.empty() && (t < window[0] || t > window[1])) continue;
    kept.push_back(row);
    log.time.push_back(t * (1 + e.skew));
  }
  if (kept.size() < 2) {
    const std::string in = window.empty() ? "" : " within its window, " + Listed(log.window) + " s";
    const std::string rows = rec.rows() > 0 && kept.empty()
                                 ? "none: it ends at " + Decimal(last) + " s"
                                 : std::to_string(kept.size());
    throw Error::Input(log.file.string() + in, "at least two rows", rows);
  }
  return kept;
}

// Puts back the full turns by which an angle [rad] jumps.
void Unwrap(std::vector<double>& angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double last = 0, turns = 0;
  bool started = false;
  for (double& value : angle) {
    if (std::isnan(value)) continue;
    if (started) turns -= std::round((value - last) / kTurn);
    started = true;
    last = value;
    value += kTurn * turns;
  }
}

// Fills what is missing of an input: with the number before it, or on the line to the next one.
void FillGaps(std::vector<double>& values, const std::vector<double>& time, bool linear) {
  std::size_t last = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::isnan(values[k])) continue;
    const double slope = linear ? (values[k] - values[last]) / (time[k] - time[last]) : 0;
    for (std::size_t i = last + 1; i < k; ++i)
      values[i] = values[last] + slope * (time[i] - time[last]);
    last = k;
  }
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(last), values.end(), values[last]);
}

// An input's numbers as they stand, nan where it may have gaps.
std::vector<double> ReadInput(const Input& in, const Recording& rec,
                              const std::vector<std::size_t>& kept) {
  std::vector<double> values(kept.size(), 0.0);
  if (in.column.empty()) return values;
  const double factor = UnitFactor(in.unit, "");
  for (std::size_t k = 0; k < kept.size(); ++k) {
    values[k] = factor * rec.Number(kept[k], in.column, true);
    if (!std::isnan(values[k]) || (in.gaps && k > 0)) continue;
    throw Error::Input(rec.Where(kept[k]) + ", column '" + in.column + "'",
                       in.gaps ? "a finite number in the first row (or begin later, by `window`)"
                               : "a finite number",
                       rec.Missing(kept[k], in.column) +
                           (in.gaps ? ""
                                    : " (slower than the other columns? `interpolate: hold` keeps "
                                      "the last number, `linear` draws lines)"));
  }
  return values;
}

void ReadInputs(Log& log, const Experiment& e, const Recording& rec,
                const std::vector<std::size_t>& kept) {
  for (const Input& in : e.inputs) {
    std::vector<double> values = ReadInput(in, rec, kept);
    if (in.unwrap) Unwrap(values);
    if (in.gaps) FillGaps(values, log.time, in.linear);
    std::vector<bool> on;
    for (const std::size_t row : kept) {
      if (!in.enable.empty()) on.push_back(rec.Flag(row, in.enable));
    }
    log.input.push_back(std::move(values));
    log.enable.push_back(std::move(on));
  }
}

void ReadChannels(Log& log, const Experiment& e, const Recording& rec,
                  const std::vector<std::size_t>& kept) {
  for (const auto& channel : e.channels) {
    std::vector<double> values;
    for (const std::size_t row : kept) {
      values.push_back(channel.factor * rec.Number(row, channel.name, true));
    }
    if (std::all_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) {
      throw Error::Input(log.file.string() + ", column '" + channel.name + "'",
                         "at least one number", "none");
    }
    if (e.outputs[channel.output].unwrap) Unwrap(values);
    log.measured.push_back(std::move(values));
  }
}

}  // namespace

std::vector<Change> ReadSettings(const Yaml& y) {
  std::vector<Change> settings;
  for (const auto& target : y.Keys()) {
    const Yaml attributes = y.At(target);
    for (const auto& attribute : attributes.Keys()) {
      settings.push_back({target, attribute, attributes.At(attribute).Number()});
    }
  }
  return settings;
}

Log ReadLog(const Yaml& y, const Experiment& e, double time_unit) {
  y.Only({"file", "variable", "trial", "use", "window", "condition", "set", "start"});
  Log log;
  log.file = y.At("file").File("a log file");
  log.label = log.file.stem().string();
  log.trial = y.TextOr("trial", log.label);
  log.condition = y.TextOr("condition", "");
  if (const auto use = y.Find("use")) {
    log.train = use->OneOf<bool>({{"train", true}, {"validate", false}});
  }
  log.variable = y.TextOr("variable", "");
  if (const auto w = y.Find("window")) {
    log.window = w->Numbers();
    if (log.window.size() != 2 || !(log.window[0] < log.window[1])) {
      throw Error::Input(w->Where(), "[begin, end] in s", Listed(log.window));
    }
    log.label += "_" + w->Items()[0].Text() + "_" + w->Items()[1].Text();
  }
  if (const auto set = y.Find("set")) log.set = ReadSettings(*set), log.set_where = set->Where();
  if (const auto start = y.Find("start")) log.start = ReadStart(*start);
  const Recording recording(log.file, log.variable);
  const auto kept = ReadTimes(log, e, recording, time_unit);
  ReadInputs(log, e, recording, kept);
  ReadChannels(log, e, recording, kept);
  return log;
}

}  // namespace continuum
