#include "models/annelida/cases.h"

#include <set>

#include "error.h"
#include "models/statics/columns.h"
#include "models/statics/results.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

constexpr const char* kForce[] = {"fx", "fy", "fz"};

void CheckColumns(const CsvTable& table, const std::vector<std::string>& cables, bool by_length) {
  std::vector<std::string> needed{"case"};
  needed.insert(needed.end(), cables.begin(), cables.end());
  std::vector<std::string> known = needed;
  if (!by_length) known.insert(known.end(), std::begin(kForce), std::end(kForce));
  statics::RefuseOtherColumns(table, known,
                              by_length ? "case and a length L1.. of every cable"
                                        : "case, a tension F1.. of every cable, fx, fy, fz");
  statics::RequireColumns(table, needed, " (F1.. or L1.. for every cable)");
}

// [N] or [m].
Eigen::VectorXd Cables(const CsvTable& table, std::size_t row,
                       const std::vector<std::string>& columns) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const std::string& column = columns[static_cast<std::size_t>(j)];
    values[j] = table.Number(row, column);
    if (values[j] >= 0) continue;
    throw Error::Input(table.Where(row) + ", column '" + column + "'", "a number >= 0",
                       Decimal(values[j]));
  }
  return values;
}

}  // namespace

std::vector<AnnelidaCase> ReadAnnelidaCases(const CsvTable& table, const AnnelidaParameters& p) {
  const std::string drive = statics::DriveOf(table, {"L", "F"});
  const bool by_length = drive == "L";
  const auto columns = statics::Numbered(drive, p.Cables());
  CheckColumns(table, columns, by_length);
  table.RequireRows();
  std::vector<AnnelidaCase> cases;
  std::set<std::string> labels;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    AnnelidaCase read;
    read.label = table.Text(row, "case");
    if (read.label.empty() || !labels.insert(read.label).second) {
      throw Error::Input(table.Where(row) + ", column 'case'", "a name that no other case has",
                         "'" + read.label + "'");
    }
    (by_length ? read.length : read.load.tension) = Cables(table, row, columns);
    for (int i = 0; i < 3; ++i) {
      if (table.Has(kForce[i])) read.load.force[i] = table.Number(row, kForce[i]);
    }
    cases.push_back(std::move(read));
  }
  return cases;
}

}  // namespace continuum
