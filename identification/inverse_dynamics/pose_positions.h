#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/model/joint_equalities.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// A measured number that follows from the positions of joints: of a joint, or of where a frame is.
struct MeasuredPlace {
  enum class Kind { kJoint, kPoint, kTurn };
  Kind kind;
  int at = 0;         ///< free dof of a joint, else id of a frame's sensor
  int component = 0;  ///< of a point: x, y or z
  double unit = 1;    ///< what counts as much as 1 of others [rad or m]
  /// [1][row] a joint's position [rad or m] or a point's coordinate [m]; [4][row] a quaternion.
  std::vector<std::vector<double>> value;
};

/// Positions of the free joints that bring frames to where they were measured, row after row, by
/// Gauss-Newton from the row before (the first from the model's pose at rest):
///
///   min Σ ((y(q) − y_measured)/unit)²,   q = q₀ + S ξ (JointEqualities)               (1)
///
/// So the tip of a soft segment gives its three coordinates, as the differential kinematics of the
/// source do (spa2022, section IV); the residual of an orientation is a rotation vector. Returns
/// [free joint][row].
///
/// Throws Error when the places do not determine every joint, with the joint or the row, and when
/// (1) does not converge.
std::vector<std::vector<double>> PositionsFromPlaces(const std::vector<MeasuredPlace>& places,
                                                     const JointEqualities& ties,
                                                     ModelAndData& machine, const std::string& log);

}  // namespace continuum
