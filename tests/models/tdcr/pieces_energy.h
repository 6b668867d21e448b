#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// The rod again, made of pieces of uniform curvature relative to each other: energy [J] of
/// bending, twisting, tendons and the force at the tip, without weight. u: curvatures [1/m], 3 x
/// pieces.
inline double EnergyOfPieces(const Robot& robot, const Loads& loads, const Eigen::Matrix3Xd& u) {
  const double h = robot.length / static_cast<double>(u.cols());
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  double energy = 0;
  for (const auto& piece : u.colwise()) {
    const double kx = piece.x(), ky = piece.y(), t = piece.z();
    energy += h * (robot.EI() * (kx * kx + ky * ky) + robot.GJ() * t * t) / 2;
    for (int k = 0; k < robot.tendons; ++k) {
      const Eigen::Vector2d a = robot.Hole(k);
      energy += h * loads.tension[static_cast<std::size_t>(k)] *
                std::hypot(1 - kx * a.x() - ky * a.y(), t * a.norm());
    }
    const Eigen::Vector3d half = h / 2 * Eigen::Vector3d(-ky, kx, t);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(half.norm(), half.normalized()).toRotationMatrix();
    tip += h * R * turn.col(2);
    R = R * turn * turn;
  }
  return energy - loads.tip_force.dot(tip);
}

}  // namespace continuum::tdcr
