#include "models/tdcr/explained.h"

#include <fmt/format.h>

#include <cmath>

namespace continuum::tdcr {
namespace {

constexpr double kExact = 1e-6;  // of the length
constexpr double kLeft = 0.5;
constexpr double kModelError = 0.05;  // of the length

}  // namespace

void Explained::Add(const Robot& robot, const Measured& measured, const Eigen::Matrix3Xd& disks) {
  if (count_ == 0) {
    sum_.setZero(3, robot.disks);
    times_.setZero(robot.disks);
    length_ = robot.length;
  }
  const Eigen::Matrix3Xd points = robot.MeasuringToBase() * measured.disks;
  for (int i = 0; i < robot.disks; ++i) {
    if (!measured.Has(i)) continue;
    const Eigen::Vector3d point = points.col(i);
    const Eigen::Vector3d straight(0, 0, robot.Place(i + 1));
    rest_ += (point - disks.col(i)).squaredNorm();
    deflected_ += (point - straight).squaredNorm();
    squares_ += point.squaredNorm();
    sum_.col(i) += point;
    times_[i] += 1;
    ++count_;
  }
}

double Explained::scatter() const {
  double about_means = squares_;
  for (Eigen::Index i = 0; i < times_.size(); ++i) {
    if (times_[i] > 0) about_means -= sum_.col(i).squaredNorm() / times_[i];
  }
  return Root(std::max(about_means, 0.0));
}

bool Explained::poor() const {
  if (rmse() <= kExact * length_) return false;
  return rmse() > kLeft * deflection() ||
         (rmse() > kLeft * scatter() && rmse() > kModelError * length_);
}

std::string Explained::Sentence() const {
  return fmt::format(
      "{:.3g} mm ({:.2g} % of the length) of the measured points are not explained; they are "
      "{:.3g} "
      "mm away from the straight robot and scatter by {:.3g} mm",
      1e3 * rmse(), 100 * rmse() / length_, 1e3 * deflection(), 1e3 * scatter());
}

}  // namespace continuum::tdcr
