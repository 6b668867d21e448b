#include "models/twin_pivot/balance.h"

#include <algorithm>

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
      reference(load.reference),
      slide(load.slide) {
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
  if (slide.size() == 0) slide.setZero(joints, cables);
}

Task Task::Between(const Task& from, double share) const {
  Task task = *this;
  const auto mix = [share](auto a, auto b) { return (1 - share) * a + share * b; };
  task.m_D = mix(from.m_D, m_D);
  task.m_NiTi = mix(from.m_NiTi, m_NiTi);
  task.rho = mix(from.rho, rho);
  task.m_CL = mix(from.m_CL, m_CL);
  task.payload = mix(from.payload, payload);
  task.gravity = (1 - share) * from.gravity + share * gravity;
  task.force = (1 - share) * from.force + share * force;
  task.moment = (1 - share) * from.moment + share * moment;
  for (std::size_t j = 0; j < tension.size(); ++j) {
    task.tension[j] = mix(from.tension[j], tension[j]);
  }
  return task;
}

Task Task::Unloaded() const {
  Task task = *this;
  task.gravity.setZero();
  task.force.setZero();
  task.moment.setZero();
  std::fill(task.tension.begin(), task.tension.end(), 0.0);
  return task;
}

}  // namespace continuum::twin_pivot
