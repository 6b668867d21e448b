#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace continuum::statics {

using Line = std::vector<Eigen::Vector3d>;

/// A disc of the robot: a short cylinder.
struct Disc {
  Eigen::Vector3d centre, normal;
  double radius;         ///< [m]
  double thickness = 0;  ///< [m]
};

/// A tendon, or a pressure chamber.
struct Drive {
  Line line;
  bool active = true;  ///< under tension, under pressure
};

/// One solved case as a picture shows it: places [m] and vectors in the base frame.
struct Shape {
  std::string label;
  Line backbone;        ///< from the base to the tip
  double diameter = 0;  ///< of the rod or of the soft body [m], drawn to scale
  std::vector<Disc> discs = {};
  std::vector<Drive> drives = {};
  Line mount = {};                                    ///< a rigid part beyond the tip
  Line measured = {};                                 ///< measured places
  Eigen::Vector3d force = Eigen::Vector3d::Zero();    ///< at the end of the mount or at the tip [N]
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double load = 0;  ///< what colours the case where cases are many, in the unit of `load_name`

  /// Where the force acts.
  const Eigen::Vector3d& End() const { return mount.empty() ? backbone.back() : mount.back(); }
};

/// Shapes of a robot under several loads.
struct Figure {
  std::string title;
  int axis = 2;            ///< base axis of the straight robot: 0 x, 1 y, 2 z
  double base_radius = 0;  ///< of the plate that the robot stands on [m]
  std::string drive_name = "tendon", idle_drive_name = "slack tendon";
  std::string load_name = "sum of tensions [N]";
  std::vector<Shape> shapes;
};

/// So many cases have a line of their own in the legend; more share a colour bar and are drawn as
/// lines with their tips.
inline constexpr std::size_t kMostNamed = 12;

}  // namespace continuum::statics
