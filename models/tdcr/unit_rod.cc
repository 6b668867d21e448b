#include "models/tdcr/unit_rod.h"

namespace continuum::tdcr {

UnitRod::UnitRod(const Robot& robot, const Loads& loads, bool with_friction)
    : twist(1 / (1 + robot.nu)),
      mu(with_friction ? loads.mu : 0),
      friction(with_friction && loads.mu > 0),
      disks(robot.disks) {
  const double unit = robot.length / robot.moment();  // L^2/EI
  for (int k = 0; k < robot.tendons; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (loads.tension[i] == 0) continue;
    holes.push_back(robot.Hole(k) / robot.length);
    pull.push_back(unit * loads.tension[i]);
    direction.push_back(loads.direction[i]);
  }
  natural =
      robot.length * Eigen::Vector3d(-robot.natural.y(), robot.natural.x(), robot.natural.z());
  tip_force = unit * loads.tip_force;
  disk_weight = unit * robot.disk_mass * loads.gravity;
  rod_weight = unit * robot.density * robot.area() * robot.length * loads.gravity;
}

}  // namespace continuum::tdcr
