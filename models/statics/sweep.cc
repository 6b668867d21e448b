#include "models/statics/sweep.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum::statics {
namespace {

constexpr std::size_t kMost = 1'000'000;

// The values that a column takes.
std::vector<std::string> ValuesOf(const CsvTable& corners, const std::string& column, int values) {
  const std::string& first = corners.Text(0, column);
  if (first == corners.Text(1, column)) return {first};
  const double low = corners.Number(0, column), high = corners.Number(1, column);
  std::vector<std::string> texts;
  for (int i = 0; i < values; ++i) {
    const double share = static_cast<double>(i) / (values - 1);
    texts.push_back(Decimal((1 - share) * low + share * high));
  }
  return texts;
}

}  // namespace

CsvTable CasesOf(const SolveRequest& request) {
  if (!request.row.empty()) return CsvTable::Parse(request.row, request.input.string());
  CsvTable table = CsvTable::Read(request.input);
  return request.sweep == 0 ? table : Grid(table, request.sweep);
}

CsvTable Grid(const CsvTable& corners, int values) {
  if (corners.rows() != 2) {
    throw Error::Input(corners.name(), "two rows, the lowest and the highest, with --sweep",
                       std::to_string(corners.rows()));
  }
  if (values < 2) throw Error::Input("--sweep", "at least 2", std::to_string(values));
  std::vector<std::vector<std::string>> columns;
  std::string text = "case";
  std::size_t count = 1;
  for (const std::string& column : corners.columns()) {
    if (column == "case") continue;
    text += "," + CsvCell(column);
    columns.push_back(ValuesOf(corners, column, values));
    count *= columns.back().size();
    if (count > kMost) {
      throw Error::Input("--sweep", fmt::format("at most {} cases", kMost), "more of them");
    }
  }
  text += "\n";
  for (std::size_t i = 0; i < count; ++i) {
    text += std::to_string(i + 1);
    std::size_t block = count;
    for (const auto& its : columns) {
      block /= its.size();
      text += "," + CsvCell(its[i / block % its.size()]);
    }
    text += "\n";
  }
  return CsvTable::Parse(text, corners.name());
}

}  // namespace continuum::statics
