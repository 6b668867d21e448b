#pragma once

#include <Eigen/Core>

#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// What a solved case holds beside its shape.
struct Held {
  Eigen::VectorXd length;  ///< of every tendon from base to tip, slack or not, without stretch [m]
  Eigen::Vector3d force;   ///< of all dead loads on the base [N], base frame
  Eigen::Vector3d moment;  ///< about the base's origin [N m]
  double strain;           ///< of the rod's most strained fibre
  /// Of bending and twist, plus tensions at the base times the tendons' lengths, less the work of
  /// the dead loads [J]; 0 of the straight robot. Without friction an equilibrium is a stationary
  /// point of it.
  double energy;
};

/// Of a solution of the same case; outcome.ok().
Held Describe(const Robot& robot, const Loads& loads, Method method, const Solution& solution);

/// The rod between base and tip.
Line LineOf(const Robot& robot, const Loads& loads, Method method, const Solution& solution);

}  // namespace continuum::tdcr
