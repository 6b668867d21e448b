#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// Steps per piece of contacts that remember: about 72 along the rod, an even number.
inline int ContactSteps(int arcs) { return 2 * std::max(1, (36 + arcs - 1) / arcs); }

/// A rod whose contacts remember.
struct Remembered {
  Eigen::VectorXd x;  ///< its unknowns
  Contacts contacts;
};

/// What a rod with given directions leaves for cases that go on from it: its contacts have slid as
/// far as they go. u: curvature of its base [1/L].
Remembered AllSlid(const Robot& robot, const Loads& loads, const Eigen::Vector3d& u);

}  // namespace continuum::tdcr
