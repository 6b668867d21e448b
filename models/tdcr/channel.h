#pragma once

#include <Eigen/Core>
#include <cmath>

namespace continuum::tdcr {

/// A point of a channel: a = (ax, ay), seen from the section of the rod, with its derivatives by s.
struct ChannelPoint {
  Eigen::Vector2d a, slope, turn;  ///< a, a', a''
};

/// Where a tendon runs between two disks: radius and angle are linear in s,
///
///   a = r e,  a' = r' e + r phi' n,  a'' = 2 r' phi' n - r phi'^2 e,
///   e = (cos phi, sin phi),  n = (-sin phi, cos phi).                                       (1)
struct Channel {
  Eigen::Vector2d hole;  ///< a where it begins; of a parallel channel everywhere
  bool parallel = true;
  double start = 0;               ///< s where it begins
  double radius = 0, widens = 0;  ///< r there, r'
  double angle = 0, turns = 0;    ///< phi there, phi'

  ChannelPoint At(double s) const {
    if (parallel) return {hole, {0, 0}, {0, 0}};
    const double r = radius + widens * (s - start), phi = angle + turns * (s - start);
    const Eigen::Vector2d e(std::cos(phi), std::sin(phi)), n(-e.y(), e.x());
    return {r * e, widens * e + r * turns * n, 2 * widens * turns * n - r * turns * turns * e};
  }
};

/// w = e_3 + u x a + a': the tendon per unit of rod, seen from the section.
template <class T>
Eigen::Matrix<T, 3, 1> Along(const ChannelPoint& c, const Eigen::Matrix<T, 3, 1>& u) {
  return {-u.z() * c.a.y() + c.slope.x(), u.z() * c.a.x() + c.slope.y(),
          1.0 + u.x() * c.a.y() - u.y() * c.a.x()};
}

/// dw/ds while u stays: u x a' + a''.
template <class T>
Eigen::Matrix<T, 3, 1> AlongDrift(const ChannelPoint& c, const Eigen::Matrix<T, 3, 1>& u) {
  return {-u.z() * c.slope.y() + c.turn.x(), u.z() * c.slope.x() + c.turn.y(),
          u.x() * c.slope.y() - u.y() * c.slope.x()};
}

/// a x v.
template <class T>
Eigen::Matrix<T, 3, 1> Lever(const Eigen::Vector2d& a, const Eigen::Matrix<T, 3, 1>& v) {
  return {v.z() * a.y(), v.z() * -a.x(), v.y() * a.x() - v.x() * a.y()};
}

}  // namespace continuum::tdcr
