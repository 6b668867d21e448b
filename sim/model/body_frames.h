#pragma once

#include <vector>

#include <mujoco/mujoco.h>
#include <Eigen/Core>

namespace continuum {

/// From the axes in which an element is written, those of its frames, to those of its body.
struct FramePose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};
FramePose FramesOf(const mjSpec& spec, mjsElement* element);

/// A point that an element is written with, in the axes of its body.
Eigen::Vector3d PlaceOf(const mjSpec& spec, mjsElement* element, const double* point);

/// Elements of a kind that a body carries. (MuJoCo's own list is of no use once one of them has
/// been deleted.)
std::vector<mjsElement*> ChildrenOf(mjSpec& spec, mjsBody& body, mjtObj kind);

/// Where the first joint of a body is, in the axes of the body; its origin, where it has none.
Eigen::Vector3d JointOf(mjSpec& spec, mjsBody& body);

}  // namespace continuum
