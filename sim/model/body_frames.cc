#include "sim/model/body_frames.h"

#include <algorithm>

#include <Eigen/Dense>

namespace continuum {

using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

Matrix3d RotationOf(const mjSpec& spec, const mjsFrame& frame) {
  double q[4];
  std::copy(frame.quat, frame.quat + 4, q);
  mjs_resolveOrientation(q, spec.compiler.degree, spec.compiler.eulerseq, &frame.alt);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace

FramePose FramesOf(const mjSpec& spec, mjsElement* element) {
  FramePose pose;
  for (mjsFrame* f = mjs_getFrame(element); f; f = mjs_getFrame(f->element)) {
    const Matrix3d R = RotationOf(spec, *f);
    pose.p = Eigen::Map<const Vector3d>(f->pos) + R * pose.p;
    pose.R = R * pose.R;
  }
  return pose;
}

std::vector<mjsElement*> ChildrenOf(mjSpec& spec, mjsBody& body, mjtObj kind) {
  std::vector<mjsElement*> children;
  for (mjsElement* e = mjs_firstElement(&spec, kind); e; e = mjs_nextElement(&spec, e)) {
    if (mjs_getParent(e) == &body) children.push_back(e);
  }
  return children;
}

Vector3d PlaceOf(const mjSpec& spec, mjsElement* element, const double* point) {
  const FramePose frames = FramesOf(spec, element);
  return frames.p + frames.R * Eigen::Map<const Vector3d>(point);
}

Vector3d JointOf(mjSpec& spec, mjsBody& body) {
  const auto joints = ChildrenOf(spec, body, mjOBJ_JOINT);
  if (joints.empty()) return Vector3d::Zero();
  return PlaceOf(spec, joints.front(), mjs_asJoint(joints.front())->pos);
}

}  // namespace continuum
