#include "models/statics/results.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"

namespace continuum::statics {
namespace {

using Cell = Results::Cell;

// A text that a reader of CSV would split or unquote is quoted.
std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos && !text.starts_with(' ') &&
      !text.ends_with(' ')) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string CsvCell(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return CsvText(*text);
  if (const auto* number = std::get_if<double>(&cell)) {
    return std::isfinite(*number) ? Decimal(*number) : "";
  }
  if (const auto* count = std::get_if<int>(&cell)) return std::to_string(*count);
  return "";
}

nlohmann::ordered_json JsonCell(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<double>(&cell); number && std::isfinite(*number)) {
    return *number;
  }
  if (const auto* count = std::get_if<int>(&cell)) return *count;
  return nullptr;
}

}  // namespace

void Results::Set(const std::string& column, Cell cell) {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) throw Error::Job("results have no column '" + column + "'");
  cells_.back()[static_cast<std::size_t>(found - columns_.begin())] = std::move(cell);
}

void Results::Set(const numerics::Outcome& outcome, const std::string& status) {
  const auto set = [&](const char* column, Cell cell) {
    if (std::find(columns_.begin(), columns_.end(), column) != columns_.end()) {
      Set(column, std::move(cell));
    }
  };
  set("status", status);
  set("iterations", outcome.iterations);
  set("residual", outcome.residual);
  set("micros", outcome.micros);
}

void Results::Set(const numerics::Outcome& outcome, const Stability& stability) {
  Set("why", outcome.ok() ? "" : outcome.why);
  if (!outcome.ok()) return;
  Set("stable", stability.stable() ? 1 : 0);
  Set("unstable_directions", stability.unstable_directions);
  Set("branch", Name(stability.branch));
}

std::string Results::Csv() const {
  std::string text;
  const auto line = [&](const auto& cells, const auto& write) {
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + write(cells[i]);
    text += '\n';
  };
  line(columns_, CsvText);
  for (const auto& row : cells_) line(row, CsvCell);
  return text;
}

std::string Results::Json() const {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : cells_) {
    auto object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.size(); ++i) object[columns_[i]] = JsonCell(row[i]);
    rows.push_back(std::move(object));
  }
  // A name may be of any bytes; JSON is UTF-8.
  return rows.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void Results::Write(const std::filesystem::path& path) const {
  RequireExtension(path, {".csv", ".json"}, "--out");
  WriteFile(path, path.extension() == ".csv" ? Csv() : Json());
}

void Write(const Results& results, const SolveRequest& request) {
  if (request.take) return request.take(results.Csv());
  results.Write(request.out);
}

std::string StatusOf(const numerics::Outcome& outcome, const Stability& stability) {
  if (!outcome.ok()) return "no_convergence";
  return stability.stable() ? "ok" : "saddle";
}

std::vector<std::string> StabilityColumns() {
  return {"stable", "unstable_directions", "branch", "why"};
}

std::vector<std::string> Numbered(const std::string& prefix, int count) {
  std::vector<std::string> names;
  for (int i = 1; i <= count; ++i) names.push_back(prefix + std::to_string(i));
  return names;
}

void RequireTable(const std::filesystem::path& path, const std::string& option) {
  if (!path.empty()) RequireExtension(path, {".csv", ".json"}, option);
}

void RequireExtension(const std::filesystem::path& path, const std::vector<std::string>& allowed,
                      const std::string& option) {
  const std::string extension = path.extension().string();
  if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return;
  std::string all;
  for (const auto& name : allowed) all += (all.empty() ? "" : " or ") + name;
  throw Error::Input(option, "a file name ending in " + all,
                     path.empty() ? "nothing" : "'" + path.string() + "'");
}

}  // namespace continuum::statics
