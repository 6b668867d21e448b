#include "sim/model/body_turn.h"

#include <algorithm>

#include <Eigen/Dense>

#include "sim/model/body_frames.h"

namespace continuum {

void TurnBody(mjSpec& spec, mjsBody& body, int axis, double angle) {
  using Eigen::AngleAxisd, Eigen::Map, Eigen::Quaterniond, Eigen::Vector3d;
  mjs_resolveOrientation(body.quat, spec.compiler.degree, spec.compiler.eulerseq, &body.alt);
  body.alt.type = mjORIENTATION_QUAT;
  Quaterniond q(body.quat[0], body.quat[1], body.quat[2], body.quat[3]);
  q.normalize();
  // In the axes in which the body is written, those of its frames.
  const Vector3d u = FramesOf(spec, body.element).R.transpose() * Vector3d::Unit(axis);
  const Quaterniond R(AngleAxisd(angle, u));
  Map<Vector3d> place(body.pos);
  const Vector3d arm = q * JointOf(spec, body);
  place += arm - R * arm;
  const Quaterniond turned = R * q;
  const double numbers[] = {turned.w(), turned.x(), turned.y(), turned.z()};
  std::copy(numbers, numbers + 4, body.quat);
}

}  // namespace continuum
