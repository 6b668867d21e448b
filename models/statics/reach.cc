#include "models/statics/reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "error.h"
#include "models/statics/box_least_squares.h"
#include "models/statics/columns.h"
#include "sim/io/decimal.h"

namespace continuum::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The tip and every disk, with the names of their columns.
std::vector<std::pair<int, std::string>> Places(int disks) {
  std::vector<std::pair<int, std::string>> places = {{disks - 1, ""}};
  for (int i = 0; i < disks; ++i) places.emplace_back(i, "_" + std::to_string(i + 1));
  return places;
}

void RequireKnown(const CsvTable& table, int disks) {
  std::vector<std::string> known = {"case", "low", "high"};
  for (const auto& [disk, suffix] : Places(disks)) {
    for (const char* axis : {"x", "y", "z"}) known.push_back(axis + suffix);
  }
  RefuseOtherColumns(
      table, known,
      fmt::format("columns case, x, y, z, x_i, y_i, z_i (i to {}), low, high", disks));
}

Target ReadTarget(const CsvTable& table, std::size_t row, int disks, double least) {
  Target target;
  target.name = table.Text(row, "case");
  for (const auto& [disk, suffix] : Places(disks)) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string column = "xyz"[axis] + suffix;
      if (!table.Has(column) || table.Text(row, column).empty()) continue;
      const double value = table.Number(row, column);
      auto& given = target.coordinate;
      if (std::find(given.begin(), given.end(), 3 * disk + axis) != given.end()) {
        throw Error::Input(table.Where(row) + ", column '" + column + "'",
                           "an empty cell beside that of the tip", Decimal(value));
      }
      given.push_back(3 * disk + axis);
      target.values.conservativeResize(target.values.size() + 1);
      target.values.tail<1>()[0] = value;
    }
  }
  if (target.coordinate.empty())
    throw Error::Input(table.Where(row), "x, y or z of a disk", "none");
  if (table.Has("low")) target.low = table.Number(row, "low");
  if (table.Has("high")) target.high = table.Number(row, "high");
  if (target.low < least) {
    throw Error::Input(table.Where(row) + ", column 'low'", "at least " + Decimal(least),
                       Decimal(target.low));
  }
  if (target.low <= target.high) return target;
  throw Error::Input(table.Where(row) + ", column 'high'", "at least " + Decimal(target.low),
                     Decimal(target.high));
}

}  // namespace

std::optional<Reached> TooFar(const Target& target, const std::function<double(int)>& most) {
  constexpr double kRounded = 1 + 1e-6;
  std::map<int, double> squares;
  for (std::size_t i = 0; i < target.coordinate.size(); ++i) {
    const double value = target.values[static_cast<Eigen::Index>(i)];
    squares[target.coordinate[i] / 3] += value * value;
  }
  for (const auto& [disk, square] : squares) {
    const double far = std::sqrt(square), reach = most(disk);
    if (far <= kRounded * reach) continue;
    Reached reached;
    reached.outcome.status = numerics::Status::kOutOfDomain;
    reached.outcome.why =
        fmt::format("out of reach: {:.3g} m from the base, and disk {} is at most {:.3g} m away",
                    far, disk + 1, reach);
    reached.miss = far - reach;
    return reached;
  }
  return std::nullopt;
}

namespace {

// Drives over `unit`, and where they lead.
struct Place {
  VectorXd w;
  Stand stand;
  double miss = 0;
};

class Search {
 public:
  Search(const StandUnder& stand, const Target& target, double unit, double length)
      : stand_(stand), target_(target), unit_(unit), length_(length) {}

  // From w on; drives are empty where w has no stable shape.
  Reached From(const VectorXd& w) const {
    constexpr int kMostRounds = 60;
    constexpr double kSettled = 1e-5;
    Reached reached;
    auto place = At(w.cwiseMax(target_.low / unit_).cwiseMin(target_.high / unit_));
    double change = 1, nearer = 0;
    while (place && change > kSettled && reached.outcome.iterations++ < kMostRounds) {
      const VectorXd step = Best(*place, VectorXd::Zero(w.size())) - place->w;
      nearer = Nearer(*place, step);
      auto next = Nearest(*place, step);
      if (next) change = (next->w - place->w).norm();
      if (place->miss > close() && (!next || next->miss > 0.5 * place->miss)) {
        // While contacts turn, on 1 um, the tangent holds for the way to the target alone.
        auto closer = Nearest(*place, Best(*place, place->w) - place->w);
        if (closer && (!next || closer->miss < next->miss)) {
          next = std::move(closer);
          change = 1;
        }
      }
      if (!next) break;
      place = std::move(next);
    }
    if (place) Judge(*place, nearer, reached);
    return reached;
  }

 private:
  double close() const { return 1e-6 * length_; }

  std::optional<Place> At(VectorXd w) const {
    auto stand = stand_(unit_ * w);
    if (!stand) return std::nullopt;
    const double miss = target_.Miss(stand->points);
    return Place{std::move(w), std::move(*stand), miss};
  }

  // By the tangent, as far as that is believed: the drives nearest to `from` at the minimum of (1).
  VectorXd Best(const Place& place, const VectorXd& from) const {
    constexpr double kWeight = 1e10, kFarthest = 1;
    const VectorXd& w = place.w;
    const MatrixXd slopes = place.stand.slopes * (unit_ / length_);
    const VectorXd wanted = (target_.values - place.stand.points) / length_ + slopes * (w - from);
    const MatrixXd H =
        MatrixXd::Identity(w.size(), w.size()) / kWeight + slopes.transpose() * slopes;
    const Eigen::ArrayXd low = (w.array() - kFarthest).max(target_.low / unit_);
    const Eigen::ArrayXd high = (w.array() + kFarthest).min(target_.high / unit_);
    return from +
           WithinLimits(H, slopes.transpose() * wanted, low.matrix() - from, high.matrix() - from);
  }

  // By how much the step comes nearer by the tangent [m].
  double Nearer(const Place& place, const VectorXd& step) const {
    return place.miss - target_.Miss(place.stand.points + unit_ * place.stand.slopes * step);
  }

  // The place that the step leads to, or a shorter one; nothing when none comes nearer. Along the
  // points at the target the drives still fall.
  std::optional<Place> Nearest(const Place& place, const VectorXd& step) const {
    constexpr double kLongest = 0.2, kShortest = 1e-4, kArmijo = 0.1;
    const double moved = unit_ / length_ * (place.stand.slopes * step).norm();
    const double nearer = Nearer(place, step);
    const double longest = std::min(1.0, kLongest / moved);
    for (double share = longest; share > kShortest * longest; share /= 2) {
      auto next = At(place.w + share * step);
      if (!next) continue;
      if (next->miss <= std::max(place.miss - kArmijo * share * nearer, close())) return next;
    }
    return std::nullopt;
  }

  void Judge(const Place& place, double nearer, Reached& reached) const {
    constexpr double kNoNearer = 1e-2;  // of the distance
    reached.drives = unit_ * place.w;
    reached.miss = place.miss;
    reached.outcome.residual = place.miss / length_;
    if (place.miss <= close()) {
      reached.outcome.status = numerics::Status::kOk;
    } else if (nearer <= kNoNearer * place.miss) {
      reached.outcome.status = numerics::Status::kOutOfDomain;
      reached.outcome.why =
          fmt::format("out of reach within the limits: {:.3g} m off at the nearest", place.miss);
    } else {
      reached.outcome.why = fmt::format("the search ends {:.3g} m off", place.miss);
    }
  }

  const StandUnder& stand_;
  const Target& target_;
  double unit_, length_;
};

}  // namespace

double Target::Miss(const VectorXd& coordinates) const {
  std::set<int> disks;
  for (const int i : coordinate) disks.insert(i / 3);
  return (values - coordinates).norm() / std::sqrt(static_cast<double>(disks.size()));
}

std::vector<Target> ReadTargets(const CsvTable& table, int disks, double least) {
  RequireKnown(table, disks);
  table.RequireRows();
  std::vector<Target> targets;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    targets.push_back(ReadTarget(table, row, disks, least));
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
    if (std::find_if(found + 1, targets.end(), its) != targets.end()) {
      throw Error::Input(file, "one target of case '" + name + "'", "more of them");
    }
    ordered.push_back(*found);
  }
  for (const Target& target : targets) {
    if (std::find(cases.begin(), cases.end(), target.name) != cases.end()) continue;
    throw Error::Input(file, "targets of the cases", "'" + target.name + "', which is none");
  }
  return ordered;
}

Reached Reach(const StandUnder& stand, const VectorXd& start, const Target& target, double unit,
              double length) {
  const Search search(stand, target, unit, length);
  Reached reached = search.From(start / unit);
  if (reached.outcome.ok()) return reached;
  Reached other = search.From(VectorXd::Zero(start.size()));
  other.outcome.iterations += reached.outcome.iterations;
  if (other.miss < reached.miss) return other;
  if (reached.drives.size() == 0) reached.outcome.why = "no start has a stable shape";
  return reached;
}

}  // namespace continuum::statics
