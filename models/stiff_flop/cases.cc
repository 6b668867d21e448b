#include <algorithm>
#include <array>

#include "error.h"
#include "models/statics/columns.h"
#include "models/stiff_flop/cases.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"

namespace continuum::stiff_flop {
namespace {

using Columns = std::array<const char*, 3>;
constexpr Columns kInverse = {"kappa", "phi", "lambda_l"};
constexpr Columns kForward = {"p1", "p2", "p3"};
constexpr Columns kForce = {"fx", "fy", "fz"};
constexpr Columns kGravity = {"gx", "gy", "gz"};

int Count(const CsvTable& table, const Columns& columns) {
  return static_cast<int>(
      std::count_if(columns.begin(), columns.end(), [&](auto* name) { return table.Has(name); }));
}

void RefuseUnknown(const CsvTable& table) {
  std::vector<std::string> known{"case"};
  for (const Columns& columns : {kInverse, kForward, kForce, kGravity}) {
    known.insert(known.end(), columns.begin(), columns.end());
  }
  statics::RefuseOtherColumns(
      table, known, "columns case, kappa, phi, lambda_l or p1, p2, p3, and fx, fy, fz, gx, gy, gz");
}

Direction DirectionOf(const CsvTable& table) {
  const int inverse = Count(table, kInverse);
  const int forward = Count(table, kForward);
  if (inverse == 3 && forward == 0) return Direction::kInverse;
  if (forward == 3 && inverse == 0) return Direction::kForward;
  std::string found;
  for (const std::string& column : table.columns()) found += (found.empty() ? "" : ", ") + column;
  throw Error::Input(table.name() + ":1",
                     "the columns kappa, phi, lambda_l (inverse) or p1, p2, p3 (forward), not both",
                     found);
}

Eigen::Vector3d Read(const CsvTable& table, std::size_t row, const Columns& columns,
                     const Eigen::Vector3d& missing) {
  Eigen::Vector3d values = missing;
  for (int i = 0; i < 3; ++i) {
    if (table.Has(columns[i])) values[i] = table.Number(row, columns[i]);
  }
  return values;
}

void CheckShape(const CsvTable& table, std::size_t row, const Eigen::Vector3d& shape) {
  if (shape[0] < 0) {
    throw Error::Input(table.Where(row) + ", column 'kappa'", "a number >= 0", Decimal(shape[0]));
  }
  if (shape[2] <= 0) {
    throw Error::Input(table.Where(row) + ", column 'lambda_l'", "a number > 0", Decimal(shape[2]));
  }
}

}  // namespace

std::string Name(Status status) {
  constexpr std::array<const char*, 4> kNames = {"ok", "out_of_domain", "no_equilibrium",
                                                 "not_converged"};
  return kNames[static_cast<std::size_t>(status)];
}

Cases Cases::Read(const std::filesystem::path& file, const Eigen::Vector3d& gravity) {
  return ReadCases(CsvTable::Read(file), gravity);
}

Cases ReadCases(const CsvTable& table, const Eigen::Vector3d& gravity) {
  RefuseUnknown(table);
  table.RequireRows();
  Cases cases{DirectionOf(table), {}};
  const bool inverse = cases.direction == Direction::kInverse;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    Case item;
    item.label = table.Has("case") ? table.Text(row, "case") : std::to_string(row + 1);
    item.given = stiff_flop::Read(table, row, inverse ? kInverse : kForward, zero);
    item.load.force = stiff_flop::Read(table, row, kForce, zero);
    item.load.gravity = stiff_flop::Read(table, row, kGravity, gravity);
    if (inverse) CheckShape(table, row, item.given);
    cases.rows.push_back(std::move(item));
  }
  return cases;
}

}  // namespace continuum::stiff_flop
