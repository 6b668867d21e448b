#pragma once

#include <string>

#include "models/tdcr/measured.h"

namespace continuum::tdcr {

/// What a model leaves of the measured points, beside what there was to explain.
///
///   rmse        distance of measured points from modelled disks
///   deflection  of measured points from the straight robot
///   scatter     of measured points about the mean of their disk over the cases
///
/// all root mean squares [m]. A fit that leaves half of the deflection, or half of the scatter and
/// more than noise or a model's own error would (5 % of the length; the paper's worst calibrated
/// model has 6.8 %, of a scatter six times as large), has explained nothing: `poor`.
class Explained {
 public:
  void Add(const Robot& robot, const Measured& measured, const Eigen::Matrix3Xd& disks);

  double rmse() const { return Root(rest_); }
  double deflection() const { return Root(deflected_); }
  double scatter() const;
  bool poor() const;
  /// One sentence for the user.
  std::string Sentence() const;

 private:
  double Root(double squares) const { return count_ > 0 ? std::sqrt(squares / count_) : 0; }

  double length_ = 0;
  double rest_ = 0, deflected_ = 0, squares_ = 0;  ///< sums of squares; of the points themselves
  Eigen::Matrix3Xd sum_;                           ///< of every disk's points
  Eigen::VectorXd times_;                          ///< that a disk was measured
  int count_ = 0;
};

}  // namespace continuum::tdcr
