#include "identification/sensitivity/rigid_body_derivatives.h"

#include "sim/model/point_jacobian.h"

namespace continuum {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = RigidBodyDerivatives::Vector6;
using Matrix6 = RigidBodyDerivatives::Matrix6;

Eigen::Map<const Vector3> At(const double* x) { return Eigen::Map<const Vector3>(x); }
Eigen::Map<const Vector6> SpatialAt(const double* x) { return Eigen::Map<const Vector6>(x); }

Matrix3 Cross(const Vector3& v) {
  Matrix3 c;
  c << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return c;
}

// V × m of twists.
Vector6 CrossMotion(const Vector6& v, const Vector6& m) {
  Vector6 out;
  out.head<3>() = v.head<3>().cross(m.head<3>());
  out.tail<3>() = v.head<3>().cross(m.tail<3>()) + v.tail<3>().cross(m.head<3>());
  return out;
}

// V ×* f of a twist and a wrench.
Vector6 CrossForce(const Vector6& v, const Vector6& f) {
  Vector6 out;
  out.head<3>() = v.head<3>().cross(f.head<3>()) + v.tail<3>().cross(f.tail<3>());
  out.tail<3>() = v.head<3>().cross(f.tail<3>());
  return out;
}

// Of inertia about a point: xx yy zz xy xz yz, mass times centre, mass, as MuJoCo keeps it.
Matrix6 SpatialInertia(const double* c) {
  Matrix6 inertia = Matrix6::Zero();
  inertia.topLeftCorner<3, 3>() << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  inertia.topRightCorner<3, 3>() = Cross(At(c + 6));
  inertia.bottomLeftCorner<3, 3>() = -inertia.topRightCorner<3, 3>();
  inertia.bottomRightCorner<3, 3>().diagonal().setConstant(c[9]);
  return inertia;
}

// B: V ×* I Ψ − I (V × Ψ) + Ψ ×* I V.
Matrix6 Turn(const Vector6& v, const Matrix6& inertia, const Vector6& momentum) {
  Matrix6 cross = Matrix6::Zero();  // V ×; V ×* is −(V ×)ᵀ
  cross.topLeftCorner<3, 3>() = cross.bottomRightCorner<3, 3>() = Cross(v.head<3>());
  cross.bottomLeftCorner<3, 3>() = Cross(v.tail<3>());
  Matrix6 turn = -cross.transpose() * inertia;
  turn.noalias() -= inertia * cross;
  const Matrix3 shift = Cross(momentum.tail<3>());
  turn.topLeftCorner<3, 3>() -= Cross(momentum.head<3>());
  turn.topRightCorner<3, 3>() -= shift;
  turn.bottomLeftCorner<3, 3>() -= shift;
  return turn;
}

}  // namespace

RigidBodyDerivatives::RigidBodyDerivatives(const mjModel& m)
    : parent_(m.dof_parentid, m.dof_parentid + m.nv),
      last_(m.nbody, -1),
      axis_(m.nv),
      psi_(m.nv),
      x_(m.nv),
      velocity_(m.nbody),
      rate_(m.nbody),
      force_(m.nbody),
      inertia_(m.nbody),
      turn_(m.nbody),
      body_(m.dof_bodyid, m.dof_bodyid + m.nv) {
  for (int b = 1; b < m.nbody; ++b) {
    last_[b] =
        m.body_dofnum[b] > 0 ? m.body_dofadr[b] + m.body_dofnum[b] - 1 : last_[m.body_parentid[b]];
  }
}

void RigidBodyDerivatives::Update(const mjModel& m, const mjData& d, const double* v,
                                  const double* a, bool weighs) {
  velocity_[0].setZero(), rate_[0].setZero();
  if (weighs && !(m.opt.disableflags & mjDSBL_GRAVITY)) rate_[0].tail<3>() = -At(m.opt.gravity);
  for (int b = 1; b < m.nbody; ++b) {
    Vector6 twist = velocity_[m.body_parentid[b]], rate = rate_[m.body_parentid[b]];
    for (int i = m.body_dofadr[b], end = i + m.body_dofnum[b]; i < end; ++i) {
      axis_[i] = SpatialAt(d.cdof + 6 * i);
      psi_[i] = CrossMotion(twist, axis_[i]);
      x_[i] = CrossMotion(rate, axis_[i]) + CrossMotion(twist, psi_[i]);
      rate += axis_[i] * a[i] + psi_[i] * v[i];
      twist += axis_[i] * v[i];
    }
    velocity_[b] = twist, rate_[b] = rate;
    inertia_[b] = SpatialInertia(d.cinert + 10 * b);
    const Vector6 momentum = inertia_[b] * twist;
    force_[b] = inertia_[b] * rate + CrossForce(twist, momentum);
    turn_[b] = Turn(twist, inertia_[b], momentum);
  }
  for (int b = static_cast<int>(m.nbody) - 1; b > 0; --b) {
    const int p = m.body_parentid[b];
    if (p == 0) continue;
    inertia_[p] += inertia_[b], force_[p] += force_[b], turn_[p] += turn_[b];
  }
}

void RigidBodyDerivatives::Add(double factor, Matrix& by_position, Matrix& by_velocity) const {
  for (int j = 0, n = static_cast<int>(axis_.size()); j < n; ++j) {
    const int b = body_[j];
    // j as the deeper one: what its motion does to itself and to those before it.
    const Vector6 moved = inertia_[b] * x_[j] + turn_[b] * psi_[j];
    const Vector6 before = moved + CrossForce(axis_[j], force_[b]);
    const Vector6 faster = 2 * (inertia_[b] * psi_[j]) + turn_[b] * axis_[j];
    by_position(j, j) += factor * axis_[j].dot(moved);
    by_velocity(j, j) += factor * axis_[j].dot(faster);
    // j as the deeper one: what the motion of those before it does to it.
    const Vector6 heavy = inertia_[b] * axis_[j], turned = turn_[b].transpose() * axis_[j];
    for (int i = parent_[j]; i >= 0; i = parent_[i]) {
      by_position(i, j) += factor * axis_[i].dot(before);
      by_velocity(i, j) += factor * axis_[i].dot(faster);
      by_position(j, i) += factor * (heavy.dot(x_[i]) + turned.dot(psi_[i]));
      by_velocity(j, i) += factor * (2 * heavy.dot(psi_[i]) + turned.dot(axis_[i]));
    }
  }
}

void RigidBodyDerivatives::AddBody(const mjModel& m, const mjData& d, int body,
                                   const double inertia[10], double factor, double* force) const {
  const Matrix3 R =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(d.xmat + 9 * body);
  const Vector3 r = At(d.xpos + 3 * body) - At(d.subtree_com + 3 * m.body_rootid[body]);
  // Twist and rate in the body's frame, the wrench back.
  const auto inward = [&](const Vector6& v) {
    Vector6 out;
    out.head<3>() = R.transpose() * v.head<3>();
    out.tail<3>() = R.transpose() * (v.tail<3>() + v.head<3>().cross(r));
    return out;
  };
  const double ordered[10] = {inertia[4], inertia[5], inertia[6], inertia[7], inertia[8],
                              inertia[9], inertia[1], inertia[2], inertia[3], inertia[0]};
  const Matrix6 added = SpatialInertia(ordered);
  const Vector6 v = inward(velocity_[body]), rate = inward(rate_[body]);
  const Vector6 own = added * rate + CrossForce(v, added * v);
  Vector6 wrench;
  wrench.tail<3>() = R * own.tail<3>();
  wrench.head<3>() = R * own.head<3>() + r.cross(wrench.tail<3>());
  for (int i = last_[body]; i >= 0; i = parent_[i]) force[i] += factor * axis_[i].dot(wrench);
}

void RigidBodyDerivatives::AddGravity(const mjModel& m, const mjModel& other, double factor,
                                      double* force) const {
  if (m.opt.disableflags & mjDSBL_GRAVITY) return;
  Vector6 more = Vector6::Zero();
  more.tail<3>() = At(other.opt.gravity) - At(m.opt.gravity);
  for (std::size_t i = 0; i < axis_.size(); ++i)
    force[i] += factor * axis_[i].dot(inertia_[body_[i]] * more);
}

}  // namespace continuum
