#include "models/tdcr/figure.h"

#include <numeric>

#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

constexpr double kRim = 1.2;  // radius of a disk over that of its holes; the file does not give it
constexpr int kParts = 4;     // points of the rod for each arc

// Frames at the base and along the rod, kParts for each arc.
Chain FineChain(const Robot& robot, const Solution& solution) {
  Eigen::Matrix3Xd fine(3, kParts * robot.disks);
  for (int i = 0; i < fine.cols(); ++i) fine.col(i) = solution.u.col(i / kParts);
  return Forward(robot.arc() / kParts, fine);
}

statics::Drive Tendon(const Robot& robot, const Loads& loads, const Chain& chain, int tendon) {
  statics::Drive drive;
  drive.active = loads.tension[static_cast<std::size_t>(tendon)] > 0;
  const Eigen::Vector2d hole = robot.Hole(tendon);
  for (std::size_t i = 0; i < chain.O.size(); i += kParts)
    drive.line.emplace_back(chain.O[i] + chain.R[i] * Eigen::Vector3d(hole.x(), hole.y(), 0));
  return drive;
}

}  // namespace

statics::Figure EmptyFigure(const Robot& robot) {
  statics::Figure figure;
  figure.axis = 2;
  figure.base_radius = 1.5 * robot.tendon_radius;
  return figure;
}

statics::Shape ShapeOf(const Robot& robot, const Loads& loads, const Solution& solution,
                       const Measured* measured) {
  const Chain chain = FineChain(robot, solution);
  statics::Shape shape;
  shape.backbone = chain.O;
  shape.diameter = robot.diameter;
  for (int i = 0; i < robot.disks; ++i) {
    const auto at = static_cast<std::size_t>(kParts * (i + 1));
    shape.discs.push_back({solution.disks.col(i), chain.R[at].col(2), kRim * robot.tendon_radius});
  }
  for (int k = 0; k < robot.tendons; ++k) shape.drives.push_back(Tendon(robot, loads, chain, k));
  if (measured != nullptr) {
    const Eigen::Matrix3Xd points = robot.MeasuringToBase() * measured->disks;
    for (int i = 0; i < robot.disks; ++i) {
      if (measured->Has(i)) shape.measured.emplace_back(points.col(i));
    }
  }
  shape.force = loads.tip_force;
  shape.gravity = loads.gravity;
  shape.load = std::accumulate(loads.tension.begin(), loads.tension.end(), 0.0);
  return shape;
}

}  // namespace continuum::tdcr
