#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace continuum::statics {

/// How far the tip of a robot stays from the path that its targets are points of: at the targets,
/// and halfway between two of them, where drives are the means of those of both.
class PathError {
 public:
  void AtTarget(const std::string& name, double miss) {
    ++rows_;
    ++reached_;
    if (miss < miss_) return;
    miss_ = miss;
    worst_ = name;
  }
  void NotReached() { ++rows_; }
  /// On the way to `name`; from, to: points of the path [m].
  void Halfway(const std::string& name, const Eigen::Vector3d& tip, const Eigen::Vector3d& from,
               const Eigen::Vector3d& to) {
    const Eigen::Vector3d along = to - from;
    const double share = (tip - from).dot(along) / std::max(along.squaredNorm(), 1e-300);
    const double off = (from + std::clamp(share, 0.0, 1.0) * along - tip).norm();
    if (off < off_) return;
    off_ = off;
    before_ = name;
  }

  std::string Sentence() const {
    std::string text = fmt::format("{} targets", rows_);
    if (reached_ < rows_) text += fmt::format(", {} of them not reached", rows_ - reached_);
    if (reached_ == 0) return text;
    text += fmt::format(", the largest error {:.3g} m at '{}'", miss_, worst_);
    if (before_.empty()) return text;
    return text +
           fmt::format("; halfway between two, {:.3g} m from the line before '{}'", off_, before_);
  }

 private:
  int rows_ = 0, reached_ = 0;
  double miss_ = 0, off_ = 0;  // largest
  std::string worst_, before_;
};

}  // namespace continuum::statics
