#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

namespace continuum::tdcr {

/// sin(a)/a, (1 - cos a)/a^2 and (1 - sin(a)/a)/a^2 of the bending angle a, with the derivative of
/// each by a, divided by a: all smooth and even at a = 0.
struct Bend {
  double A, B, C;
  double dA, dB;

  /// square: a^2 >= 0.
  explicit Bend(double square) {
    if (square < 0.25) {  // power series; the first term left out is below 1e-16
      const double q = square;
      A = Series(q, {6, 20, 42, 72, 110, 156});
      B = Series(q, {12, 30, 56, 90, 132, 182}) / 2;
      C = Series(q, {20, 42, 72, 110, 156, 210}) * (1. / 6);
      dB = Series(q, {15, 112. / 3, 67.5, 105.6, 455. / 3}) * (-1. / 12);
    } else {
      const double a = std::sqrt(square);
      A = std::sin(a) / a;
      const double half = std::sin(a / 2);
      B = 2 * half * half / square;
      C = (1 - A) / square;
      dB = (A - 2 * B) / square;
    }
    dA = C - B;  // (cos a - A)/a^2 with cos a = 1 - B a^2
  }

 private:
  // 1 - q/d_1 (1 - q/d_2 (1 - ..))
  template <std::size_t N>
  static constexpr double Series(double q, const double (&divisors)[N]) {
    double sum = 1;
    for (std::size_t i = N; i-- > 0;) sum = 1 - q * (1 / divisors[i]) * sum;
    return sum;
  }
};

/// An arc of constant curvature, (5)-(6) written without the angle phi: with v = l (kappa_x,
/// kappa_y) and the twist psi = l tau,
///
///   Q = exp((-v_y, v_x, 0)),   D = Q R_z(psi),   p = l (B v, A).
struct Arc {
  double l;
  Eigen::Vector2d v;
  double psi, cos_psi, sin_psi;
  Bend bend;

  /// u = (kappa_x, kappa_y, tau) [1/m].
  Arc(double length, const Eigen::Vector3d& u)
      : l(length),
        v(length * u.x(), length * u.y()),
        psi(length * u.z()),
        cos_psi(std::cos(psi)),
        sin_psi(std::sin(psi)),
        bend(v.squaredNorm()) {}

  Eigen::Matrix3d Q() const {
    const auto& [A, B, C, dA, dB] = bend;
    Eigen::Matrix3d q;
    q << 1 - B * v.x() * v.x(), -B * v.x() * v.y(), A * v.x(),  //
        -B * v.x() * v.y(), 1 - B * v.y() * v.y(), A * v.y(),   //
        -A * v.x(), -A * v.y(), 1 - B * v.squaredNorm();
    return q;
  }

  /// x -> R_z(psi) x of the first two columns.
  Eigen::Matrix3d Twisted(const Eigen::Matrix3d& q) const {
    Eigen::Matrix3d d;
    d.col(0) = cos_psi * q.col(0) + sin_psi * q.col(1);
    d.col(1) = cos_psi * q.col(1) - sin_psi * q.col(0);
    d.col(2) = q.col(2);
    return d;
  }

  Eigen::Vector3d p() const { return {l * bend.B * v.x(), l * bend.B * v.y(), l * bend.A}; }

  /// dp/d(v_x, v_y): 3 x 2. The twist does not move the end.
  Eigen::Matrix<double, 3, 2> dp() const {
    const auto& [A, B, C, dA, dB] = bend;
    Eigen::Matrix<double, 3, 2> d;
    d.topRows<2>() = l * dB * v * v.transpose();
    d(0, 0) += l * B;
    d(1, 1) += l * B;
    d.row(2) = l * dA * v.transpose();
    return d;
  }

  /// The rotation of Q for a change of (v_x, v_y), in the frame of the arc's start: J_l of the
  /// rotation group, J = 1 + B [w] + C [w]^2 with w = (-v_y, v_x, 0), times dw/dv.
  Eigen::Matrix<double, 3, 2> Rotation() const {
    const auto& [A, B, C, dA, dB] = bend;
    const double x = v.x(), y = v.y();
    Eigen::Matrix<double, 3, 2> j;
    j << -C * x * y, C * x * x - 1,  //
        1 - C * y * y, C * x * y,    //
        -B * y, B * x;
    return j;
  }
};

}  // namespace continuum::tdcr
