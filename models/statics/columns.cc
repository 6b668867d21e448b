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

}  // namespace continuum::statics
