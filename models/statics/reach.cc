#include "models/statics/reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "error.h"
#include "models/statics/box_least_squares.h"
#include "sim/io/decimal.h"

namespace continuum::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kReached = 1e-6;  // of the length

// The tip and every disk, with the names of their columns.
std::vector<std::pair<int, std::string>> Places(int disks) {
  std::vector<std::pair<int, std::string>> places = {{disks - 1, ""}};
  for (int i = 0; i < disks; ++i) places.emplace_back(i, "_" + std::to_string(i + 1));
  return places;
}

void RequireKnown(const CsvTable& table, int disks) {
  std::set<std::string> known = {"case", "low", "high"};
  for (const auto& [disk, suffix] : Places(disks)) {
    for (const char* axis : {"x", "y", "z"}) known.insert(axis + suffix);
  }
  for (const std::string& column : table.columns()) {
    if (known.contains(column)) continue;
    throw Error::Input(
        table.name() + ":1",
        fmt::format("columns case, x, y, z, x_i, y_i, z_i (i to {}), low, high", disks),
        "'" + column + "'");
  }
}

Target ReadTarget(const CsvTable& table, std::size_t row, int disks) {
  Target target;
  target.name = table.Text(row, "case");
  for (const auto& [disk, suffix] : Places(disks)) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string column = "xyz"[axis] + suffix;
      const double value = table.Has(column) ? table.NumberOrNan(row, column) : std::nan("");
      if (std::isnan(value)) continue;
      target.coordinate.push_back(3 * disk + axis);
      target.values.conservativeResize(target.values.size() + 1);
      target.values.tail<1>()[0] = value;
    }
  }
  if (target.coordinate.empty())
    throw Error::Input(table.Where(row), "x, y or z of a disk", "none");
  if (table.Has("low")) target.low = table.Number(row, "low");
  if (table.Has("high")) target.high = table.Number(row, "high");
  if (target.low <= target.high) return target;
  throw Error::Input(table.Where(row) + ", column 'high'", "at least " + Decimal(target.low),
                     Decimal(target.high));
}

// The drives at the minimum of (1) with the tangent, over `unit`.
VectorXd Best(const Stand& at, const VectorXd& w, const Target& target, double unit,
              double length) {
  constexpr double kWeight = 1e10;
  const MatrixXd slopes = at.slopes * (unit / length);
  const VectorXd wanted = (target.values - at.points) / length + slopes * w;
  const MatrixXd H = MatrixXd::Identity(w.size(), w.size()) / kWeight + slopes.transpose() * slopes;
  return WithinLimits(H, slopes.transpose() * wanted,
                      VectorXd::Constant(w.size(), target.low / unit),
                      VectorXd::Constant(w.size(), target.high / unit));
}

}  // namespace

double Target::Miss(const VectorXd& coordinates) const {
  std::set<int> disks;
  for (const int i : coordinate) disks.insert(i / 3);
  return (values - coordinates).norm() / std::sqrt(static_cast<double>(disks.size()));
}

std::vector<Target> ReadTargets(const CsvTable& table, int disks) {
  RequireKnown(table, disks);
  table.RequireRows();
  std::vector<Target> targets;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    targets.push_back(ReadTarget(table, row, disks));
  }
  return targets;
}

std::vector<Target> TargetsOf(const std::vector<Target>& targets,
                              const std::vector<std::string>& cases, const std::string& file) {
  std::vector<Target> ordered;
  for (const std::string& name : cases) {
    const auto its = [&](const Target& target) { return target.name == name; };
    const auto found = std::find_if(targets.begin(), targets.end(), its);
    if (found == targets.end()) throw Error::Input(file, "a target of case '" + name + "'", "none");
    ordered.push_back(*found);
  }
  for (const Target& target : targets) {
    if (std::find(cases.begin(), cases.end(), target.name) != cases.end()) continue;
    throw Error::Input(file, "targets of the cases", "'" + target.name + "', which is none");
  }
  return ordered;
}

Reached Reach(const std::function<std::optional<Stand>(const VectorXd&)>& stand, VectorXd start,
              const Target& target, double unit, double length) {
  constexpr int kMostRounds = 60;
  constexpr double kLongest = 0.2, kSettled = 1e-5, kShortest = 1e-4;
  Reached reached;
  VectorXd w = (start / unit).cwiseMax(target.low / unit).cwiseMin(target.high / unit);
  auto at = stand(unit * w);
  if (!at) {
    reached.outcome.why = "the start has no stable shape";
    return reached;
  }
  reached.miss = target.Miss(at->points);
  while (reached.outcome.iterations++ < kMostRounds) {
    const VectorXd step = Best(*at, w, target, unit, length) - w;
    const double moved = unit / length * (at->slopes * step).norm();
    double share = std::min(1.0, kLongest / std::max(moved, 1e-300));
    std::optional<Stand> next;
    double miss = 0;
    for (; share > kShortest; share /= 2) {
      next = stand(unit * (w + share * step));
      if (!next) continue;
      miss = target.Miss(next->points);
      // Along the points of equal distance the drives still fall.
      if (miss <= std::max((1 - 0.1 * share) * reached.miss, kReached * length)) break;
    }
    if (!next || share <= kShortest) break;
    w += share * step;
    at = std::move(next);
    reached.miss = miss;
    if (share * step.norm() <= kSettled) break;
  }
  reached.drives = unit * w;
  reached.outcome.residual = reached.miss / length;
  if (reached.miss <= kReached * length) {
    reached.outcome.status = numerics::Status::kOk;
  } else {
    reached.outcome.why =
        fmt::format("out of reach within the limits: {:.3g} m off at the nearest", reached.miss);
  }
  return reached;
}

}  // namespace continuum::statics
