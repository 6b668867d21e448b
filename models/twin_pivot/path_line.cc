#include "models/twin_pivot/path_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/columns.h"
#include "sim/io/decimal.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Vector3d;

constexpr double kOnAxis = 1e-6;  // m

void RequireColumns(const CsvTable& table) {
  statics::RefuseOtherColumns(table, {"x", "y", "z", "low", "high"},
                              "the columns x, y, z of a path [m], and low, high [N]");
  statics::RequireColumns(table, {"x", "y", "z"});
  if (table.rows() >= 2) return;
  throw Error::Input(table.name(), "two points of a path or more", std::to_string(table.rows()));
}

double Limit(const CsvTable& table, std::size_t row, const char* column, double least,
             double otherwise) {
  if (!table.Has(column)) return otherwise;
  const double value = table.Number(row, column);
  if (value >= least) return value;
  throw Error::Input(table.Where(row) + ", column '" + column + "'",
                     "a tension of at least " + Decimal(least) + " N", Decimal(value));
}

Vector3d Nearest(const Vector3d& p, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  return from + std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

}  // namespace

PathLine::PathLine(const CsvTable& table) {
  RequireColumns(table);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Vector3d p(table.Number(row, "x"), table.Number(row, "y"), table.Number(row, "z"));
    if (row == 0 && p.tail<2>().norm() > kOnAxis) {
      throw Error::Input(table.Where(row), "a first point on the base's axis, y = z = 0",
                         fmt::format("y = {:.4g}, z = {:.4g}", p.y(), p.z()));
    }
    const double step = row == 0 ? 0 : (p - points_.back()).norm();
    if (row > 0 && !(step > 0)) {
      throw Error::Input(table.Where(row), "another point than the one before", "the same");
    }
    where_.push_back(table.Where(row));
    points_.push_back(p);
    s_.push_back(row == 0 ? 0 : s_.back() + step);
    low_.push_back(Limit(table, row, "low", 0, 0));
    high_.push_back(
        Limit(table, row, "high", low_.back(), std::numeric_limits<double>::infinity()));
  }
}

Vector3d PathLine::At(double s) const {
  if (s <= 0) return points_.front() + Vector3d(s, 0, 0);
  const auto after = std::upper_bound(s_.begin() + 1, s_.end() - 1, s) - s_.begin();
  const auto i = static_cast<std::size_t>(after);
  const double share = (s - s_[i - 1]) / (s_[i] - s_[i - 1]);
  return points_[i - 1] + share * (points_[i] - points_[i - 1]);
}

double PathLine::Distance(const Vector3d& from) const {
  const Vector3d& first = points_.front();
  double least = (from - Vector3d(std::min(from.x(), first.x()), first.y(), first.z())).norm();
  for (std::size_t i = 1; i < points_.size(); ++i) {
    least = std::min(least, (from - Nearest(from, points_[i - 1], points_[i])).norm());
  }
  return least;
}

double PathLine::Base(std::size_t point, double length) const {
  const double s = s_[point] - length;
  for (std::size_t i = 1; i < points_.size() && s_[i - 1] < s; ++i) {
    const Vector3d reached = s < s_[i] ? At(s) : points_[i];
    if (reached.tail<2>().norm() <= kOnAxis) continue;
    throw Error::Input(where_[point],
                       fmt::format("at most {:.4g} m of path beyond the base's axis, the length of "
                                   "the robot",
                                   length),
                       fmt::format("{:.4g} m", s_[point]));
  }
  return At(s).x();
}

}  // namespace continuum::twin_pivot
