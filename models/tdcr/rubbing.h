#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "models/tdcr/channel.h"

namespace continuum::tdcr {

/// A tendon that loses tension along its channel, at one point of a rod of curvature u:
///
///   w = e_3 + u x a + a',  t = w/|w|,  t' = u x t + (w' - t t.w')/|w|
///   w' = u' x a + u x a' + a''                                                              (1)
///   T' = -loss |t'|,  loss = dir mu T                                                       (2)
///
/// a = (ax, ay, 0) is the hole. |t'| has a kink where the tendon is straight; 1e-12 rounds it off.
template <class T>
class Rubbing {
 public:
  using Vector3 = Eigen::Matrix<T, 3, 1>;

  Rubbing() = default;
  Rubbing(const ChannelPoint& at, bool parallel, const Vector3& u, const T& loss)
      : ax_(at.a.x()), ay_(at.a.y()), loss_(loss) {
    using std::sqrt;
    const Vector3 w = Along(at, u);
    inverse_ = 1.0 / sqrt(w.squaredNorm());
    t_ = w * inverse_;
    still_ = u.cross(t_);
    if (!parallel) still_ += Across(AlongDrift(at, u));
  }

  /// T' by (2).
  T Slope(const Vector3& du) const { return -loss_ * Rate(Turn(du)); }

  /// dT'/du'. By (1) t' has no part along t, so the projection drops out.
  Vector3 Gradient(const Vector3& du) const {
    const Vector3 turn = Turn(du);
    return Cross(turn) * (-loss_ * inverse_ / Rate(turn));
  }

  /// a x t: the moment that goes with a unit of tension.
  Vector3 Lever() const { return Cross(t_); }

 private:
  static T Rate(const Vector3& turn) {
    using std::sqrt;
    return sqrt(turn.squaredNorm() + 1e-24);
  }
  Vector3 Cross(const Vector3& v) const {
    return {v.z() * ay_, v.z() * -ax_, v.y() * ax_ - v.x() * ay_};
  }
  Vector3 Turn(const Vector3& du) const {
    const Vector3 dw(-du.z() * ay_, du.z() * ax_, du.x() * ay_ - du.y() * ax_);
    return still_ + Across(dw);
  }
  Vector3 Across(const Vector3& dw) const { return (dw - t_ * t_.dot(dw)) * inverse_; }

  double ax_ = 0, ay_ = 0;
  T loss_, inverse_;
  Vector3 t_, still_;
};

}  // namespace continuum::tdcr
