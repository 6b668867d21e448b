#include "models/tdcr/measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "error.h"

namespace continuum::tdcr {
namespace {

void RejectUnknownDisks(const CsvTable& table, int disks) {
  for (const auto& column : table.columns()) {
    if (column.size() < 3 || column[1] != '_' ||
        std::string("xyz").find(column[0]) == std::string::npos) {
      continue;
    }
    const std::string number = column.substr(2);
    if (number.find_first_not_of("0123456789") != number.npos) continue;
    bool known = false;
    for (int i = 1; i <= disks; ++i) known = known || number == std::to_string(i);
    if (!known) {
      throw Error::Input(table.name() + ":1", fmt::format("disks 1 to {}", disks),
                         "'" + column + "'");
    }
  }
}

bool IsTest(const CsvTable& table, std::size_t row) {
  if (!table.Has("use")) return false;
  const std::string& use = table.Text(row, "use");
  if (use == "test") return true;
  if (use == "train" || use.empty()) return false;
  throw Error::Input(table.Where(row) + ", column 'use'", "train or test", "'" + use + "'");
}

void ReadDisk(const CsvTable& table, std::size_t row, int disk, Eigen::Matrix3Xd& disks) {
  const std::string end = "_" + std::to_string(disk + 1);
  const char* const axes[3] = {"x", "y", "z"};
  int missing = 0;
  for (int a = 0; a < 3; ++a) {
    disks(a, disk) = table.NumberOrNan(row, axes[a] + end);
    missing += std::isnan(disks(a, disk));
  }
  if (missing == 1 || missing == 2) {
    throw Error::Input(table.Where(row), fmt::format("all of x{0}, y{0}, z{0} or none", end),
                       fmt::format("{} of them empty", missing));
  }
}

}  // namespace

int Measured::count() const {
  int found = 0;
  for (int i = 0; i < disks.cols(); ++i) found += Has(i);
  return found;
}

std::vector<Measured> ReadMeasured(const CsvTable& table, int disks) {
  RejectUnknownDisks(table, disks);
  table.RequireRows();
  std::vector<bool> present;
  for (int i = 1; i <= disks; ++i) {
    present.push_back(
        HasVector(table, {fmt::format("x_{}", i), fmt::format("y_{}", i), fmt::format("z_{}", i)}));
  }
  std::vector<Measured> measured(table.rows());
  std::set<std::string> names;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Measured& m = measured[row];
    m.name = table.Text(row, "case");
    if (!names.insert(m.name).second) {
      throw Error::Input(table.Where(row), "every case once", "'" + m.name + "' again");
    }
    m.test = IsTest(table, row);
    m.disks.setConstant(3, disks, std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; i < disks; ++i) {
      if (present[static_cast<std::size_t>(i)]) ReadDisk(table, row, i, m.disks);
    }
    if (m.count() == 0) throw Error::Input(table.Where(row), "at least one measured disk", "none");
  }
  return measured;
}

const Measured* Find(const std::vector<Measured>& measured, const std::string& name) {
  const auto found = std::find_if(measured.begin(), measured.end(),
                                  [&](const Measured& m) { return m.name == name; });
  return found == measured.end() ? nullptr : &*found;
}

Eigen::VectorXd Errors(const Robot& robot, const Measured& measured,
                       const Eigen::Matrix3Xd& disks) {
  return (robot.MeasuringToBase() * measured.disks - disks).colwise().norm().transpose();
}

std::optional<Spread> Statistics(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto v =
      Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  Spread spread{v.mean(), 0, v.minCoeff(), v.maxCoeff()};
  if (v.size() > 1) {
    spread.std = std::sqrt((v - spread.mean).square().sum() / static_cast<double>(v.size() - 1));
  }
  return spread;
}

void TipErrors::Add(const Robot& robot, const Measured& measured, const Eigen::Matrix3Xd& disks) {
  if (!measured.Has(robot.disks - 1)) return;
  const double error = Errors(robot, measured, disks)[robot.disks - 1];
  (measured.test ? test : train).push_back(100 * error / robot.length);
}

void RequireShared(const std::vector<Case>& cases, const std::vector<Measured>& measured,
                   const std::string& file) {
  const auto is_measured = [&](const Case& c) { return Find(measured, c.name) != nullptr; };
  if (std::any_of(cases.begin(), cases.end(), is_measured)) return;
  throw Error::Input(file, "a measured shape of one of the cases", "none");
}

std::vector<Pair> Match(const std::vector<Case>& cases, const std::vector<Measured>& measured,
                        const std::string& file) {
  RequireShared(cases, measured, file);
  std::vector<Pair> pairs;
  bool train = false;
  for (const Case& c : cases) {
    const Measured* const m = Find(measured, c.name);
    if (m == nullptr) continue;
    pairs.push_back({&c, m});
    train = train || !m->test;
  }
  if (!train) throw Error::Input(file, "a measured case with 'use' train", "only test");
  return pairs;
}

}  // namespace continuum::tdcr
