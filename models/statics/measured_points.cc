#include "models/statics/measured_points.h"

#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/columns.h"

namespace continuum::statics {
namespace {

// What stands behind x, y and z of a disk; that of the tip, which is the last disk, may be nothing.
std::string Suffix(int disk) { return fmt::format("_{}", disk + 1); }

bool HasPoint(const CsvTable& table, const std::string& suffix) {
  const std::vector<std::string> columns{"x" + suffix, "y" + suffix, "z" + suffix};
  const auto has = [&](const std::string& column) { return table.Has(column); };
  if (std::none_of(columns.begin(), columns.end(), has)) return false;
  RequireColumns(table, columns);
  return true;
}

void RequireKnownColumns(const CsvTable& table, int disks) {
  std::vector<std::string> known{"case", "use", "x", "y", "z"};
  for (int i = 0; i < disks; ++i) {
    for (const char* axis : {"x", "y", "z"}) known.push_back(axis + Suffix(i));
  }
  RefuseOtherColumns(table, known,
                     fmt::format("columns case, use, x, y, z, x_i, y_i, z_i (i to {})", disks));
  RequireColumns(table, {"case"});
}

bool IsTest(const CsvTable& table, std::size_t row) {
  if (!table.Has("use")) return false;
  const std::string& use = table.Text(row, "use");
  if (use == "test") return true;
  if (use.empty() || use == "train") return false;
  throw Error::Input(table.Where(row) + ", column 'use'", "train or test", "'" + use + "'");
}

// The point, or NaN where its cells are empty.
Eigen::Vector3d ReadPoint(const CsvTable& table, std::size_t row, const std::string& suffix) {
  Eigen::Vector3d point;
  for (int a = 0; a < 3; ++a) point[a] = table.NumberOrNan(row, "xyz"[a] + suffix);
  const auto missing = point.array().isNaN().count();
  if (missing == 0 || missing == 3) return point;
  throw Error::Input(table.Where(row), fmt::format("all of x{0}, y{0}, z{0} or none", suffix),
                     fmt::format("{} of them empty", missing));
}

}  // namespace

int MeasuredPoints::count() const {
  int found = 0;
  for (Eigen::Index i = 0; i < disks.cols(); ++i) found += Has(i);
  return found;
}

std::vector<MeasuredPoints> ReadMeasuredPoints(const CsvTable& table, int disks) {
  RequireKnownColumns(table, disks);
  table.RequireRows();
  std::vector<std::pair<int, std::string>> places;
  for (int i = 0; i < disks; ++i) {
    if (HasPoint(table, Suffix(i))) places.emplace_back(i, Suffix(i));
  }
  if (HasPoint(table, "")) {
    if (!places.empty() && places.back().first == disks - 1) {
      throw Error::Input(table.name() + ":1",
                         "the tip once, as x, y, z or as x" + Suffix(disks - 1) + " ..", "both");
    }
    places.emplace_back(disks - 1, "");
  }
  std::vector<MeasuredPoints> measured(table.rows());
  std::set<std::string> names;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    MeasuredPoints& m = measured[row];
    m.name = table.Text(row, "case");
    if (!names.insert(m.name).second) {
      throw Error::Input(table.Where(row), "every case once", "'" + m.name + "' again");
    }
    m.test = IsTest(table, row);
    m.disks.setConstant(3, disks, std::numeric_limits<double>::quiet_NaN());
    for (const auto& [disk, suffix] : places) m.disks.col(disk) = ReadPoint(table, row, suffix);
    if (m.count() == 0) throw Error::Input(table.Where(row), "at least one measured disk", "none");
  }
  return measured;
}

const MeasuredPoints* Find(const std::vector<MeasuredPoints>& measured, const std::string& name) {
  const auto found = std::find_if(measured.begin(), measured.end(),
                                  [&](const MeasuredPoints& m) { return m.name == name; });
  return found == measured.end() ? nullptr : &*found;
}

void RequireShared(const std::vector<std::string>& cases,
                   const std::vector<MeasuredPoints>& measured, const std::string& file) {
  const auto is_measured = [&](const std::string& name) { return Find(measured, name) != nullptr; };
  if (std::any_of(cases.begin(), cases.end(), is_measured)) return;
  throw Error::Input(file, "a measured shape of one of the cases", "none");
}

}  // namespace continuum::statics
