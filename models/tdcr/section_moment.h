#pragma once

#include <Eigen/Core>

#include "models/tdcr/channel.h"

namespace continuum::tdcr {

/// The moment of a section of the rod and all its tendons, (2) of cosserat.h, and its slope by the
/// curvature u. Units of L and EI/L.
template <class T>
struct SectionMoment {
  using Vector3 = Eigen::Matrix<T, 3, 1>;

  Vector3 moment;            ///< nu
  T xx, xy, yy, xz, yz, zz;  ///< H = dnu/du, symmetric
  bool slanted = false;      ///< some channel is not parallel to the rod
  Vector3 drift;             ///< then dnu/ds while u stays

  /// The rod alone: K (u - u_0).
  SectionMoment(const Vector3& u, const Eigen::Vector3d& natural, const Eigen::Vector3d& K)
      : moment(K.x() * (u.x() - natural.x()), K.y() * (u.y() - natural.y()),
               K.z() * (u.z() - natural.z())),
        xx(K.x()),
        xy(0),
        yy(K.y()),
        xz(0),
        yz(0),
        zz(K.z()) {}

  Eigen::Matrix<T, 3, 3> Hessian() const {
    Eigen::Matrix<T, 3, 3> h;
    h << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return h;
  }
  /// H^-1 b.
  Vector3 Solve(const Vector3& b) const {
    const T cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const T cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
    const T determinant = 1.0 / (xx * cxx + xy * cxy + xz * cxz);
    return Vector3((cxx * b.x() + cxy * b.y() + cxz * b.z()) * determinant,
                   (cxy * b.x() + cyy * b.y() + cyz * b.z()) * determinant,
                   (cxz * b.x() + cyz * b.y() + czz * b.z()) * determinant);
  }

  /// A tendon that runs parallel to the rod at `hole`. along: |w|. @returns false where it does not
  /// go forwards.
  bool AddParallel(const Eigen::Vector2d& hole, const T& pull, const Vector3& u, T& along) {
    using std::sqrt;
    const double ax = hole.x(), ay = hole.y(), r2 = hole.squaredNorm();
    const T wz = 1.0 + u.x() * ay - u.y() * ax;
    if (!(wz > T(0))) return false;
    const T side = r2 * u.z() * u.z();
    const T square = wz * wz + side;
    along = sqrt(square);
    const T inverse = pull / along;
    moment.x() += inverse * wz * ay;
    moment.y() -= inverse * wz * ax;
    moment.z() += inverse * u.z() * r2;
    // Hessian of T |w| by (wz, u_z), with dwz/du = (ay, -ax, 0).
    const T cube = inverse / square;
    const T by_wz = cube * side;
    const T mixed = cube * wz * u.z() * r2;
    xx += by_wz * (ay * ay);
    xy -= by_wz * (ax * ay);
    yy += by_wz * (ax * ax);
    xz -= mixed * ay;
    yz += mixed * ax;
    zz += cube * wz * wz * r2;
    return true;
  }

  /// Any other tendon: with t = w/|w| and the lever c = a x t,
  ///
  ///   T c,  H = T/|w| (r^2 - a a^T - c c^T),
  ///   drift T (a' x t + a x (d - t t.d)/|w|),  d = u x a' + a''.
  bool AddSlanted(const ChannelPoint& p, const T& pull, const Vector3& u, T& along) {
    using std::sqrt;
    const double ax = p.a.x(), ay = p.a.y(), r2 = p.a.squaredNorm();
    const Vector3 w = Along(p, u);
    if (!(w.z() > T(0))) return false;
    along = sqrt(w.squaredNorm());
    const T inverse = 1.0 / along, stiff = pull * inverse;
    const Vector3 t = w * inverse;
    const Vector3 c = Lever(p.a, t);
    moment += pull * c;
    xx += stiff * (r2 - ax * ax - c.x() * c.x());
    xy -= stiff * (ax * ay + c.x() * c.y());
    yy += stiff * (r2 - ay * ay - c.y() * c.y());
    xz -= stiff * c.x() * c.z();
    yz -= stiff * c.y() * c.z();
    zz += stiff * (r2 - c.z() * c.z());
    const Vector3 d = AlongDrift(p, u);
    if (!slanted) drift.setZero();
    slanted = true;
    drift += pull * (Lever(p.slope, t) + Lever(p.a, Vector3((d - t * t.dot(d)) * inverse)));
    return true;
  }
};

}  // namespace continuum::tdcr
