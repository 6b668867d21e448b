#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "error.h"
#include "models/statics/columns.h"
#include "models/statics/results.h"
#include "models/stiff_flop/case.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"

namespace continuum::stiff_flop {
namespace {

using Columns = std::vector<std::string>;
const Columns kInverse = {"kappa", "phi", "lambda_l"};
const Columns kForce = {"fx", "fy", "fz"};
const Columns kGravity = {"gx", "gy", "gz"};

Columns Pressures(const Robot& robot) {
  return statics::Numbered("p", static_cast<int>(robot.series.lines()));
}

std::string Listed(const Columns& columns) { return fmt::format("{}", fmt::join(columns, ", ")); }

std::size_t Count(const CsvTable& table, const Columns& columns) {
  return static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [&](auto& name) { return table.Has(name); }));
}

void RefuseUnknown(const CsvTable& table, const Columns& pressures) {
  Columns known{"case"};
  for (const Columns* columns : {&kInverse, &pressures, &kForce, &kGravity}) {
    known.insert(known.end(), columns->begin(), columns->end());
  }
  statics::RefuseOtherColumns(table, known,
                              "columns case, kappa, phi, lambda_l or " + Listed(pressures) +
                                  ", and fx, fy, fz, gx, gy, gz");
}

Direction DirectionOf(const CsvTable& table, const Columns& pressures) {
  const std::size_t inverse = Count(table, kInverse);
  const std::size_t forward = Count(table, pressures);
  if (inverse == kInverse.size() && forward == 0) return Direction::kInverse;
  if (forward == pressures.size() && inverse == 0) return Direction::kForward;
  throw Error::Input(
      table.name() + ":1",
      "the columns kappa, phi, lambda_l (inverse) or " + Listed(pressures) + " (forward), not both",
      Listed(table.columns()));
}

Eigen::VectorXd Read(const CsvTable& table, std::size_t row, const Columns& columns,
                     const Eigen::VectorXd& missing) {
  Eigen::VectorXd values = missing;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (table.Has(columns[i])) {
      values[static_cast<Eigen::Index>(i)] = table.Number(row, columns[i]);
    }
  }
  return values;
}

void CheckShape(const CsvTable& table, std::size_t row, const Eigen::VectorXd& shape) {
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

Cases Cases::Read(const CsvTable& table, const Robot& robot) {
  const Columns pressures = Pressures(robot);
  RefuseUnknown(table, pressures);
  table.RequireRows();
  Cases cases{DirectionOf(table, pressures), {}};
  const bool inverse = cases.direction == Direction::kInverse;
  if (inverse && robot.series.size() > 1) {
    throw Error::Input(table.name() + ":1",
                       "the columns " + Listed(pressures) + " (kappa is of one module)",
                       Listed(table.columns()));
  }
  const Columns& given = inverse ? kInverse : pressures;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(given.size()));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Case item;
    item.label = table.Has("case") ? table.Text(row, "case") : std::to_string(row + 1);
    item.given = stiff_flop::Read(table, row, given, none);
    item.load.force = stiff_flop::Read(table, row, kForce, Eigen::Vector3d::Zero());
    item.load.gravity = stiff_flop::Read(table, row, kGravity, robot.gravity);
    if (inverse) CheckShape(table, row, item.given);
    cases.rows.push_back(std::move(item));
  }
  return cases;
}

}  // namespace continuum::stiff_flop
