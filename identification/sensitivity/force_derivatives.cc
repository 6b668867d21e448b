#include "identification/sensitivity/force_derivatives.h"

#include <algorithm>

namespace continuum {
namespace {

bool OnTendon(const mjModel& m, int actuator) {
  return m.actuator_trntype[actuator] == mjTRN_TENDON;
}

int DofOf(const mjModel& m, int actuator) { return m.jnt_dofadr[m.actuator_trnid[2 * actuator]]; }

}  // namespace

std::string ForceDerivatives::Obstacle(const mjModel& m) {
  if (m.nv == 0) return "nothing moves";
  if (m.opt.enableflags & mjENBL_SLEEP) return "what rests may sleep";
  const std::string why = NativeForceObstacle(m);
  return why.empty() ? TendonDerivatives::Obstacle(m) : why;
}

ForceDerivatives::ForceDerivatives(const mjModel& m)
    : rigid_(m),
      tendons_(m),
      a_(m.nv),
      felt_(m.nv),
      of_tendon_(m.ntendon),
      by_position_(m.nv, m.nv),
      by_velocity_(m.nv, m.nv),
      by_activation_(m.nv, m.na),
      damping_(m.nv, m.nv) {}

// What acts at d, but by the speeds that it feels: it is linear in them.
ForceAlong ForceDerivatives::Joint(const mjModel& by, const mjData& d, int joint) const {
  const int i = by.jnt_dofadr[joint];
  return JointForce(by, d, joint, d.qvel[i]).Felt(felt_[i] - d.qvel[i]);
}

ForceAlong ForceDerivatives::Tendon(const mjModel& by, const mjData& d, int tendon) const {
  const double rate = tendons_.Rate(by, d, tendon, d.qvel);
  return TendonForce(by, d, tendon, rate).Felt(tendons_.Rate(by, d, tendon, felt_.data()) - rate);
}

ForceAlong ForceDerivatives::Actuator(const mjModel& by, const mjData& d, int actuator) const {
  const auto rate = [&](const double* v) {
    return OnTendon(by, actuator) ? tendons_.Rate(by, d, by.actuator_trnid[2 * actuator], v)
                                  : v[DofOf(by, actuator)];
  };
  const double now = rate(d.qvel);
  return ActuatorForce(by, d, actuator, now, step_).Felt(rate(felt_.data()) - now);
}

void ForceDerivatives::PullAlong(const mjModel& m, const mjData& d, int actuator, double f,
                                 double* force) const {
  if (OnTendon(m, actuator)) {
    tendons_.ForceAlong(m, d, m.actuator_trnid[2 * actuator], f, force);
  } else {
    force[DofOf(m, actuator)] += f;
  }
}

void ForceDerivatives::Update(const mjModel& m, const mjData& d, const double* a,
                              const double* felt, double step) {
  a_.assign(a, a + m.nv), felt_.assign(felt, felt + m.nv), step_ = step;
  for (Matrix* all : {&by_position_, &by_velocity_, &by_activation_}) all->setZero();
  for (int t = 0; t < m.ntendon; ++t) of_tendon_[t] = Tendon(m, d, t);
  for (int j = 0; j < m.njnt; ++j) {
    const int i = m.jnt_dofadr[j];
    const ForceAlong pull = Joint(m, d, j);
    by_position_(i, i) += pull.by_length, by_velocity_(i, i) += pull.by_rate;
  }
  for (int k = 0; k < m.nactuator; ++k) {
    const ForceAlong pull = Actuator(m, d, k);
    if (OnTendon(m, k)) {
      of_tendon_[m.actuator_trnid[2 * k]] += pull;
    } else {
      const int i = DofOf(m, k);
      by_position_(i, i) += pull.by_length, by_velocity_(i, i) += pull.by_rate;
    }
    if (pull.by_activation != 0)
      PullAlong(m, d, k, pull.by_activation, by_activation_.col(m.actuator_actadr[k]).data());
  }
  tendons_.Update(m, d);
  for (int t = 0; t < m.ntendon; ++t) {
    const ForceAlong& pull = of_tendon_[t];
    if (pull.f == 0 && pull.by_length == 0 && pull.by_rate == 0) continue;
    tendons_.Add(m, d, t, pull.f, pull.by_length, pull.by_rate, felt, by_position_, by_velocity_);
  }
  damping_ = by_velocity_;
  rigid_.Update(m, d, a);
  rigid_.Add(-1, by_position_, by_velocity_);
}

void ForceDerivatives::Differ(const mjModel& m, const mjData& d, const mjModel& other,
                              const ModelDifference& difference, double* force) const {
  for (const int j : difference.joints)
    force[m.jnt_dofadr[j]] += Joint(other, d, j).f - Joint(m, d, j).f;
  for (const int i : difference.armatures)
    force[i] -= (other.dof_armature[i] - m.dof_armature[i]) * a_[i];
  for (const int t : difference.tendons)
    tendons_.ForceAlong(m, d, t, Tendon(other, d, t).f - Tendon(m, d, t).f, force);
  for (const int k : difference.actuators)
    PullAlong(m, d, k, Actuator(other, d, k).f - Actuator(m, d, k).f, force);
  for (const auto& body : difference.bodies)
    rigid_.AddBody(m, d, body.id, body.inertia.data(), -1, force);
  if (difference.gravity) rigid_.AddGravity(m, other, force);
}

}  // namespace continuum
