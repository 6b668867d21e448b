#include "sim/model/body_length.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "sim/model/body_frames.h"
#include "sim/model/body_inertia.h"

namespace continuum {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

// The points of an element that a body carries, each three numbers.
std::vector<double*> PointsOf(mjsElement* element) {
  if (mjsBody* const body = mjs_asBody(element)) return {body->pos};
  if (mjsSite* const site = mjs_asSite(element)) {
    if (std::isnan(site->fromto[0])) return {site->pos};
    return {site->fromto, site->fromto + 3};
  }
  mjsGeom& geom = *mjs_asGeom(element);
  if (std::isnan(geom.fromto[0])) return {geom.pos};
  return {geom.fromto, geom.fromto + 3};
}

// From the joint; zero: it has no axis.
Vector3d AxisOf(mjSpec& spec, mjsBody& body, const mjModel& compiled, const Vector3d& joint) {
  constexpr double kLeast = 1e-9;  // m
  Vector3d farthest = Vector3d::Zero();
  for (mjsElement* const child : ChildrenOf(spec, body, mjOBJ_BODY)) {
    const Vector3d r = PlaceOf(spec, child, mjs_asBody(child)->pos) - joint;
    if (r.norm() > farthest.norm()) farthest = r;
  }
  if (farthest.norm() <= kLeast) {
    const int b = mj_name2id(&compiled, mjOBJ_BODY, mjs_getString(mjs_getName(body.element)));
    farthest = Eigen::Map<const Vector3d>(compiled.body_ipos + 3 * b) - joint;
  }
  return farthest.norm() > kLeast ? farthest.normalized() : Vector3d::Zero();
}

}  // namespace

void ScaleBodyLength(mjSpec& spec, mjsBody& body, const mjModel& compiled, double factor,
                     const std::function<void(mjsElement*)>& before) {
  const Vector3d a = JointOf(spec, body), u = AxisOf(spec, body, compiled, a);
  if (u.isZero()) return;
  const Matrix3d A = Matrix3d::Identity() + (factor - 1) * u * u.transpose();  // (1)
  MapBodyMass(spec, body, compiled, A, a - A * a);
  for (const mjtObj kind : {mjOBJ_BODY, mjOBJ_SITE, mjOBJ_GEOM}) {
    for (mjsElement* const child : ChildrenOf(spec, body, kind)) {
      before(child);
      const FramePose frames = FramesOf(spec, child);
      for (double* const point : PointsOf(child)) {
        Eigen::Map<Vector3d> x(point);
        const Vector3d from_joint = frames.p + frames.R * x - a;
        x += frames.R.transpose() * (factor - 1) * u * u.dot(from_joint);
      }
    }
  }
}

}  // namespace continuum
