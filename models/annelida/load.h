#pragma once

#include <Eigen/Core>

namespace continuum {

/// What holds the snake arm: tension of every cable at the base [N], a dead force on the tip [N].
///
/// Base frame of all of this: z along the straight arm, that is down, x as the world's.
struct AnnelidaLoad {
  Eigen::VectorXd tension;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/// How the tension of a cable changes along it.
enum class AnnelidaPull {
  kEven,   ///< without friction: the middle of what friction can hold
  kSlowly  ///< it was pulled in and slides at every hole: T exp(−μ Σ wrap angles), eq. 8
};

}  // namespace continuum
