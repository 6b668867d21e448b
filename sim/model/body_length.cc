#include "sim/model/body_length.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "sim/model/body_inertia.h"

namespace continuum {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

// From the axes in which an element is written, those of its frames, to those of its body.
struct Pose {
  Matrix3d R = Matrix3d::Identity();
  Vector3d p = Vector3d::Zero();
};

Matrix3d RotationOf(const mjSpec& spec, const mjsFrame& frame) {
  double q[4];
  std::copy(frame.quat, frame.quat + 4, q);
  mjs_resolveOrientation(q, spec.compiler.degree, spec.compiler.eulerseq, &frame.alt);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

Pose FramesOf(const mjSpec& spec, mjsElement* element) {
  Pose pose;
  for (mjsFrame* f = mjs_getFrame(element); f; f = mjs_getFrame(f->element)) {
    const Matrix3d R = RotationOf(spec, *f);
    pose.p = Eigen::Map<const Vector3d>(f->pos) + R * pose.p;
    pose.R = R * pose.R;
  }
  return pose;
}

// MuJoCo's own list of a body's children is of no use once one of them has been deleted.
std::vector<mjsElement*> ChildrenOf(mjSpec& spec, mjsBody& body, mjtObj kind) {
  std::vector<mjsElement*> children;
  for (mjsElement* e = mjs_firstElement(&spec, kind); e; e = mjs_nextElement(&spec, e)) {
    if (mjs_getParent(e) == &body) children.push_back(e);
  }
  return children;
}

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

Vector3d PlaceOf(const mjSpec& spec, mjsElement* element, const double* point) {
  const Pose frames = FramesOf(spec, element);
  return frames.p + frames.R * Eigen::Map<const Vector3d>(point);
}

Vector3d JointOf(mjSpec& spec, mjsBody& body) {
  const auto joints = ChildrenOf(spec, body, mjOBJ_JOINT);
  if (joints.empty()) return Vector3d::Zero();
  return PlaceOf(spec, joints.front(), mjs_asJoint(joints.front())->pos);
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
      const Pose frames = FramesOf(spec, child);
      for (double* const point : PointsOf(child)) {
        Eigen::Map<Vector3d> x(point);
        const Vector3d from_joint = frames.p + frames.R * x - a;
        x += frames.R.transpose() * (factor - 1) * u * u.dot(from_joint);
      }
    }
  }
}

}  // namespace continuum
