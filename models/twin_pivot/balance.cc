#include "models/twin_pivot/balance.h"

#include <algorithm>
#include <string>

#include "error.h"
#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {

namespace {

// One value of each joint's section.
Eigen::VectorXd ByJoint(const Robot& robot, const PerSection& value) {
  Eigen::VectorXd of(robot.Joints());
  for (int m = 0; m < of.size(); ++m) of[m] = value[robot.SectionOfJoint(m)];
  return of;
}

Eigen::VectorXd ByCable(const Robot& robot, const PerSection& value) {
  Eigen::VectorXd of(robot.Cables());
  for (int j = 0; j < of.size(); ++j) of[j] = value[robot.SectionOfCable(j)];
  return of;
}

// Forces are taken where one of two tasks has any.
std::vector<DiscLoad> Mix(const std::vector<DiscLoad>& from, const std::vector<DiscLoad>& to,
                          double share) {
  std::vector<DiscLoad> mixed;
  const auto add = [&](const std::vector<DiscLoad>& loads, double part) {
    for (const DiscLoad& load : loads) {
      mixed.push_back({load.disc, part * load.force, part * load.moment});
    }
  };
  add(from, 1 - share);
  add(to, share);
  return mixed;
}

}  // namespace

Method ParseMethod(const std::string& name) {
  if (name.empty() || name == "virtual_work") return Method::kVirtualWork;
  if (name == "printed") return Method::kPrinted;
  throw Error::Input("--method", "virtual_work or printed", "'" + name + "'");
}

Task::Task(const Robot& r, const Load& load, Method chosen)
    : robot(r),
      method(chosen),
      joints(r.Joints()),
      cables(r.Cables()),
      links(r.Links()),
      stiffness(joints),
      m_D(ByJoint(r, r.m_D)),
      payload(load.condition == Condition::kV ? load.payload : 0),
      gravity(load.gravity),
      force(load.force),
      moment(load.moment),
      loads(load.on_discs),
      tension(load.tension),
      reference(load.reference),
      slide(load.slide) {
  const bool all = load.condition != Condition::kIV;
  m_NiTi = ByJoint(r, all ? r.m_NiTi : 0);
  rho = ByCable(r, all ? r.rho_cable : 0);
  m_CL = ByCable(r, all ? r.m_CL : 0);
  for (int m = 0; m < joints; ++m) stiffness[m] = r.Stiffness(r.SectionOfJoint(m));
  if (load.condition == Condition::kV && load.disc_payload.size() > 0) m_D += load.disc_payload;
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
  const auto mix = [share](const auto& a, const auto& b) { return (1 - share) * a + share * b; };
  task.m_D = mix(from.m_D, m_D);
  task.m_NiTi = mix(from.m_NiTi, m_NiTi);
  task.rho = mix(from.rho, rho);
  task.m_CL = mix(from.m_CL, m_CL);
  task.payload = mix(from.payload, payload);
  task.gravity = mix(from.gravity, gravity);
  task.force = mix(from.force, force);
  task.moment = mix(from.moment, moment);
  task.loads = Mix(from.loads, loads, share);
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
  task.loads.clear();
  std::fill(task.tension.begin(), task.tension.end(), 0.0);
  return task;
}

}  // namespace continuum::twin_pivot
