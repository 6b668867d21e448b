#include "sim/model/body_inertia.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Dense>

#include "error.h"

namespace continuum {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

std::string NameOf(const mjsBody& body) { return mjs_getString(mjs_getName(body.element)); }
std::string Who(const mjsBody& body) { return "body '" + NameOf(body) + "'"; }
int IdOf(const mjsBody& body, const mjModel& compiled) {
  return mj_name2id(&compiled, mjOBJ_BODY, NameOf(body).c_str());
}

// Makes the inertia that compilation found explicit, with a quaternion, so that it can be edited.
void FreezeInertia(const mjSpec& spec, mjsBody& body, const mjModel& compiled) {
  if (spec.compiler.inertiafromgeom == mjINERTIAFROMGEOM_TRUE || spec.compiler.settotalmass > 0) {
    throw Error::Input(Who(body) + ": mass",
                       "a <compiler> without inertiafromgeom=\"true\" and settotalmass",
                       "one that overrides the mass of a body");
  }
  if (body.explicitinertial) {
    const char* const failed = mjs_resolveOrientation(body.iquat, spec.compiler.degree,
                                                      spec.compiler.eulerseq, &body.ialt);
    if (failed) throw Error::Input(Who(body) + ": inertial", failed);
    body.ialt.type = mjORIENTATION_QUAT;
    return;
  }
  const int b = IdOf(body, compiled);
  body.explicitinertial = 1;
  body.mass = compiled.body_mass[b];
  const bool massless = body.mass == 0;  // its compiled centre means nothing
  for (int i = 0; i < 3; ++i) {
    body.ipos[i] = massless ? 0 : compiled.body_ipos[3 * b + i];
    body.inertia[i] = compiled.body_inertia[3 * b + i];
  }
  const double unit[4] = {1, 0, 0, 0};
  for (int i = 0; i < 4; ++i) body.iquat[i] = massless ? unit[i] : compiled.body_iquat[4 * b + i];
  body.ialt.type = mjORIENTATION_QUAT;
  body.fullinertia[0] = NAN;
}

// About the centre of mass, in the axes of the body.
Matrix3d InertiaOf(const mjsBody& body) {
  if (std::isfinite(body.fullinertia[0])) {
    const double* const f = body.fullinertia;
    Matrix3d inertia;
    inertia << f[0], f[3], f[4], f[3], f[1], f[5], f[4], f[5], f[2];
    return inertia;
  }
  double r[9];
  mju_quat2Mat(r, body.iquat);
  const Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r);
  return R * Eigen::Map<const Vector3d>(body.inertia).asDiagonal() * R.transpose();
}

void SetInertia(mjsBody& body, const Matrix3d& inertia) {
  const double full[6] = {inertia(0, 0), inertia(1, 1), inertia(2, 2),
                          inertia(0, 1), inertia(0, 2), inertia(1, 2)};
  std::copy(full, full + 6, body.fullinertia);
  const double unit[4] = {1, 0, 0, 0};
  std::copy(unit, unit + 4, body.iquat);
  for (double& i : body.inertia) i = 0;
}

}  // namespace

double BodyMass(const mjSpec& spec, const mjsBody& body, const mjModel& compiled) {
  if (body.explicitinertial && spec.compiler.inertiafromgeom != mjINERTIAFROMGEOM_TRUE)
    return body.mass;
  return compiled.body_mass[IdOf(body, compiled)];
}

void SetBodyMass(const mjSpec& spec, mjsBody& body, const mjModel& compiled, double mass) {
  FreezeInertia(spec, body, compiled);
  const double factor = body.mass > 0 ? mass / body.mass : 0;
  body.mass = mass;
  for (double& i : body.inertia) i *= factor;
  if (std::isfinite(body.fullinertia[0])) {
    for (double& i : body.fullinertia) i *= factor;
  }
}

void AddPointMass(const mjSpec& spec, mjsBody& body, const mjModel& compiled, double added) {
  if (added == 0) return;
  FreezeInertia(spec, body, compiled);
  Matrix3d inertia = InertiaOf(body);
  const auto steiner = [](double m, const Vector3d& r) -> Matrix3d {
    return m * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  };
  const Vector3d centre = Eigen::Map<const Vector3d>(body.ipos);
  const double total = body.mass + added;
  const Vector3d moved = centre * (body.mass / total);
  inertia += steiner(body.mass, centre - moved) + steiner(added, moved);
  body.mass = total;
  for (int i = 0; i < 3; ++i) body.ipos[i] = moved[i];
  // A point alone has no inertia; the compiler asks for some: that of a ball of 0.1 mm, however
  // light.
  if (inertia.eigenvalues().real().minCoeff() <= 1e-12)
    inertia.diagonal().array() += std::max(4e-9 * total, 1e-13);
  SetInertia(body, inertia);
}

// With the second moments S = ∫ r rᵀ dm about the centre, I = tr(S) 1 − S; the map makes A S Aᵀ of
// them.
void MapBodyMass(const mjSpec& spec, mjsBody& body, const mjModel& compiled, const Matrix3d& A,
                 const Vector3d& b) {
  FreezeInertia(spec, body, compiled);
  if (body.mass == 0) return;
  const Matrix3d inertia = InertiaOf(body);
  const Matrix3d S = inertia.trace() / 2 * Matrix3d::Identity() - inertia,
                 mapped = A * S * A.transpose();
  const Vector3d centre = b + A * Eigen::Map<const Vector3d>(body.ipos);
  std::copy(centre.data(), centre.data() + 3, body.ipos);
  SetInertia(body, mapped.trace() * Matrix3d::Identity() - mapped);
}

}  // namespace continuum
