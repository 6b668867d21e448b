#include "models/statics/columns.h"

#include <algorithm>

#include "error.h"

namespace continuum::statics {

void RefuseOtherColumns(const CsvTable& table,
                        const std::function<bool(const std::string&)>& is_known,
                        const std::string& expected) {
  for (const std::string& column : table.columns()) {
    if (is_known(column)) continue;
    throw Error::Input(table.name() + ":1, column '" + column + "'", expected, "'" + column + "'");
  }
}

void RefuseOtherColumns(const CsvTable& table, const std::vector<std::string>& known,
                        const std::string& expected) {
  const auto is_known = [&](const std::string& column) {
    return std::find(known.begin(), known.end(), column) != known.end();
  };
  RefuseOtherColumns(table, is_known, expected);
}

void RequireColumns(const CsvTable& table, const std::vector<std::string>& needed,
                    const std::string& hint) {
  for (const std::string& column : needed) {
    if (table.Has(column)) continue;
    throw Error::Input(table.name() + ":1", "a column '" + column + "'" + hint, "none");
  }
}

std::string DriveOf(const CsvTable& table, const std::vector<std::string>& letters) {
  const auto is_numbered = [](const std::string& column, const std::string& letter) {
    const std::string number = column.starts_with(letter) ? column.substr(letter.size()) : "";
    return !number.empty() && number.find_first_not_of("0123456789") == number.npos;
  };
  for (const std::string& letter : letters) {
    for (const std::string& column : table.columns()) {
      if (is_numbered(column, letter)) return letter;
    }
  }
  return letters.back();
}

}  // namespace continuum::statics
