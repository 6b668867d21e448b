#include "models/tdcr/unit_rod.h"

namespace continuum::tdcr {

UnitRod::UnitRod(const Robot& robot, const Loads& loads, bool with_friction, bool all)
    : twist(1 / (1 + robot.nu)),
      mu(with_friction ? loads.mu : 0),
      friction(with_friction && (loads.mu > 0 || all)),
      disks(robot.disks) {
  const double unit = robot.length / robot.moment();  // L^2/EI
  for (int k = 0; k < robot.tendons; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (loads.tension[i] == 0 && !all) continue;
    tendon.push_back(k);
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

void UnitRod::Mix(const UnitRod& from, const UnitRod& to, double share) {
  const double rest = 1 - share;
  for (std::size_t k = 0; k < pull.size(); ++k) pull[k] = rest * from.pull[k] + share * to.pull[k];
  tip_force = rest * from.tip_force + share * to.tip_force;
  disk_weight = rest * from.disk_weight + share * to.disk_weight;
  rod_weight = rest * from.rod_weight + share * to.rod_weight;
}

UnitRod UnitRod::Unloaded() const {
  UnitRod none = *this;
  none.pull.assign(pull.size(), 0);
  none.tip_force.setZero();
  none.disk_weight.setZero();
  none.rod_weight.setZero();
  return none;
}

}  // namespace continuum::tdcr
