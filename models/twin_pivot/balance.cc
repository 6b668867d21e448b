#include "models/twin_pivot/balance.h"

#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {

Task::Task(const Robot& r, const Load& load, Method chosen)
    : robot(r),
      method(chosen),
      joints(r.Joints()),
      cables(r.Cables()),
      m_D(r.m_D),
      payload(load.condition == Condition::kV ? load.payload : 0),
      gravity(load.gravity),
      force(load.force),
      moment(load.moment),
      tension(load.tension),
      reference(load.reference) {
  const bool all = load.condition != Condition::kIV;
  m_NiTi = all ? r.m_NiTi : 0;
  rho = all ? r.rho_cable : 0;
  m_CL = all ? r.m_CL : 0;
  if (load.condition == Condition::kIII) {
    friction.c = r.mu_const;
  } else if (load.condition != Condition::kI) {
    friction = r.friction;
  }
  for (int j = 0; j < cables; ++j) {
    anchor.push_back(r.Anchor(j));
    hole_y.push_back(r.r[j] * std::cos(r.phi[j]));
    hole_z.push_back(r.r[j] * std::sin(r.phi[j]));
  }
  if (reference.size() == 0) reference = CableLengths(r, Eigen::VectorXd::Zero(joints));
}

}  // namespace continuum::twin_pivot
