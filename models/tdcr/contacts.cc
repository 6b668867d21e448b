#include "models/tdcr/contacts.h"

#include "models/tdcr/cosserat.h"

namespace continuum::tdcr {

Remembered AllSlid(const Robot& robot, const Loads& loads, const Eigen::Vector3d& u) {
  const int steps = ContactSteps(CountArcs(robot));
  const RodBalance balance = RodBalance::Remembering(robot, loads, steps, nullptr);
  const Eigen::VectorXd x = balance.Slid(u);
  return {x, balance.ContactsAt(x)};
}

}  // namespace continuum::tdcr
