#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "effects/effect.h"

namespace continuum {

/// Motion of the actuator's base frame, z along the straight arm. All vectors but the position are
/// in base axes.
template <class T>
struct SpaBase {
  using Vector = Eigen::Matrix<T, 3, 1>;
  Eigen::Matrix<T, 3, 3> R_WB = Eigen::Matrix<T, 3, 3>::Identity();  ///< base to world axes
  Vector p_WB = Vector::Zero();                                      ///< origin in world axes [m]
  Vector velocity = Vector::Zero();                                  ///< of the origin [m/s]
  Vector angular_velocity = Vector::Zero();                          ///< [rad/s]
  Vector acceleration = Vector::Zero();          ///< of the origin against the world [m/s²]
  Vector angular_acceleration = Vector::Zero();  ///< [rad/s²]

  /// A base at rest that hangs its arm along world −z.
  static SpaBase Hanging() {
    SpaBase base;
    base.R_WB.diagonal() << T(1.0), T(-1.0), T(-1.0);
    return base;
  }
};

/// The floating base in the six coordinates q₀ = (x, y, z, α, β, γ) of (6)-(7),
/// R_WB = Rx(α) Ry(β) Rz(γ), lengths in m and angles in rad.
template <class T>
struct SpaCardan {
  using Vector6 = Eigen::Matrix<T, 6, 1>;
  using Matrix3 = Eigen::Matrix<T, 3, 3>;

  static Matrix3 Rotation(const Vector6& q) {
    const T ca = cos(q[3]), sa = sin(q[3]), cb = cos(q[4]), sb = sin(q[4]), cg = cos(q[5]),
            sg = sin(q[5]);
    Matrix3 r;
    r << cb * cg, -cb * sg, sb,                                    //
        ca * sg + sa * sb * cg, ca * cg - sa * sb * sg, -sa * cb,  //
        sa * sg - ca * sb * cg, sa * cg + ca * sb * sg, ca * cb;
    return r;
  }

  /// ω = E(β, γ) (α̇, β̇, γ̇), in base axes.
  static Matrix3 Rates(const Vector6& q) {
    const T cb = cos(q[4]), sb = sin(q[4]), cg = cos(q[5]), sg = sin(q[5]);
    Matrix3 e;
    e << cb * cg, sg, T(0.0), -cb * sg, cg, T(0.0), sb, T(0.0), T(1.0);
    return e;
  }

  /// (velocity, angular velocity) = Jacobian(q₀) q̇₀, so that the generalised forces on q₀ are
  /// Jacobianᵀ (force, torque).
  static Eigen::Matrix<T, 6, 6> Jacobian(const Vector6& q) {
    Eigen::Matrix<T, 6, 6> j = Eigen::Matrix<T, 6, 6>::Zero();
    j.template topLeftCorner<3, 3>() = Rotation(q).transpose();
    j.template bottomRightCorner<3, 3>() = Rates(q);
    return j;
  }

  static SpaBase<T> Base(const Vector6& q, const Vector6& rate, const Vector6& acceleration) {
    const T cb = cos(q[4]), sb = sin(q[4]), cg = cos(q[5]), sg = sin(q[5]);
    const T ad = rate[3], bd = rate[4], gd = rate[5];
    const Matrix3 rates = Rates(q);
    SpaBase<T> base;
    base.R_WB = Rotation(q);
    base.p_WB = q.template head<3>();
    base.velocity = base.R_WB.transpose() * rate.template head<3>();
    base.angular_velocity = rates * rate.template tail<3>();
    base.acceleration = base.R_WB.transpose() * acceleration.template head<3>();
    base.angular_acceleration = rates * acceleration.template tail<3>();
    base.angular_acceleration[0] += (-sb * cg * bd - cb * sg * gd) * ad + cg * gd * bd;
    base.angular_acceleration[1] += (sb * sg * bd - cb * cg * gd) * ad - sg * gd * bd;
    base.angular_acceleration[2] += cb * bd * ad;
    return base;
  }
};

}  // namespace continuum
