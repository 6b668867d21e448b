#include "identification/sensitivity/force_derivatives.h"

#include <algorithm>
#include <cmath>

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

ForceDerivatives::Implicit ForceDerivatives::ImplicitOf(const mjModel& m) {
  if (m.opt.integrator == mjINT_IMPLICIT) return Implicit::kMotion;
  if (m.opt.integrator == mjINT_IMPLICITFAST) return Implicit::kForces;
  const bool damped = m.opt.integrator == mjINT_EULER && !(m.opt.disableflags & mjDSBL_EULERDAMP);
  return damped ? Implicit::kJoints : Implicit::kNothing;
}

ForceDerivatives::ForceDerivatives(const mjModel& m, const Parts& parts)
    : parts_(parts),
      rigid_(m),
      tendons_(m),
      v_(m.nv),
      a_(m.nv),
      felt_(m.nv),
      of_tendon_(m.ntendon),
      pull_(m.ntendon),
      by_position_(m.nv, m.nv),
      by_velocity_(m.nv, m.nv),
      by_activation_(m.nv, m.na),
      damping_(m.nv, m.nv) {
  if (parts.implicit == Implicit::kMotion) beyond_.emplace(m);
}

// Spring and damper at the rate that is felt; at_rest: the same at no rate.
ForceAlong ForceDerivatives::Weighed(ForceAlong at_rest, double felt) const {
  at_rest.f = parts_.springs * at_rest.f + parts_.dampers * at_rest.by_rate * felt;
  at_rest.by_length *= parts_.springs, at_rest.by_rate *= parts_.dampers;
  return at_rest;
}

ForceAlong ForceDerivatives::Joint(const mjModel& by, const mjData& d, int joint) const {
  return Weighed(JointForce(by, d, joint, 0), FeltBy(Implicit::kJoints)[by.jnt_dofadr[joint]]);
}

ForceAlong ForceDerivatives::Tendon(const mjModel& by, const mjData& d, int tendon) const {
  return Weighed(TendonForce(by, d, tendon, 0),
                 tendons_.Rate(by, d, tendon, FeltBy(Implicit::kForces).data()));
}

// What acts at d, but by the speeds that it feels: it is linear in them.
ForceAlong ForceDerivatives::Actuator(const mjModel& by, const mjData& d, int actuator) const {
  const auto rate = [&](const double* v) {
    return OnTendon(by, actuator) ? tendons_.Rate(by, d, by.actuator_trnid[2 * actuator], v)
                                  : v[DofOf(by, actuator)];
  };
  const double now = rate(d.qvel), more = rate(FeltBy(Implicit::kForces).data()) - now;
  if (!given_.empty() && !std::isnan(given_[actuator])) {
    const double gear = by.actuator_gear[6 * by.actuator_outadr[actuator]], f = given_[actuator];
    const double* const range = by.actuator_forcerange + 2 * actuator;
    const bool limited = by.actuator_forcelimited[actuator] && (f <= range[0] || f >= range[1]);
    const double by_rate =
        limited ? 0 : gear * UnlimitedOutput(by, d, actuator, now, step_).by_rate;
    return ForceAlong{gear * f, 0, by_rate, 0}.Felt(more).Times(parts_.actuators);
  }
  return ActuatorForce(by, d, actuator, now, step_).Felt(more).Times(parts_.actuators);
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
  v_.assign(d.qvel, d.qvel + m.nv), a_.assign(a, a + m.nv);
  felt_.assign(felt, felt + m.nv), step_ = step;
  for (Matrix* all : {&by_position_, &by_velocity_, &by_activation_, &damping_}) all->setZero();
  for (int t = 0; t < m.ntendon; ++t) of_tendon_[t] = Tendon(m, d, t);
  for (int j = 0; j < m.njnt; ++j) {
    const int i = m.jnt_dofadr[j];
    const ForceAlong pull = Joint(m, d, j);
    by_position_(i, i) += pull.by_length, by_velocity_(i, i) += pull.by_rate;
  }
  if (parts_.implicit >= Implicit::kJoints) damping_ = by_velocity_;
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
  for (int t = 0; t < m.ntendon; ++t) {
    ForceAlong& pull = of_tendon_[t];
    pull.f += pull_[t];
    if (pull.f == 0 && pull.by_length == 0 && pull.by_rate == 0) continue;
    tendons_.Add(m, d, t, pull.f, pull.by_length, pull.by_rate, FeltBy(Implicit::kForces).data(),
                 by_position_, by_velocity_);
  }
  if (parts_.implicit >= Implicit::kForces) damping_ = by_velocity_;
  if (parts_.motion != 0) AddMotion(m, d);
}

void ForceDerivatives::AddMotion(const mjModel& m, const mjData& d) {
  if (!parts_.moves) std::fill(v_.begin(), v_.end(), 0.0), a_ = v_;
  rigid_.Update(m, d, FeltBy(Implicit::kMotion).data(), a_.data());
  rigid_.Add(-parts_.motion, by_position_, by_velocity_);
  if (!beyond_) return;
  std::vector<double> x(felt_), rest(m.nv, 0);
  for (int i = 0; i < m.nv; ++i) x[i] -= v_[i];
  beyond_->Update(m, d, x.data(), rest.data(), false);
  damping_ = by_velocity_;  // ∂c/∂q̇ is 2 Q(q̇ + x, ·) − 2 Q(x, ·)
  beyond_->Add(parts_.motion, by_position_, damping_);
}

void ForceDerivatives::Differ(const mjModel& m, const mjData& d, const mjModel& other,
                              const ModelDifference& difference, double* force) const {
  for (const int j : difference.joints)
    force[m.jnt_dofadr[j]] += Joint(other, d, j).f - Joint(m, d, j).f;
  for (const int i : difference.armatures)
    force[i] -= parts_.motion * (other.dof_armature[i] - m.dof_armature[i]) * a_[i];
  for (const int t : difference.tendons)
    tendons_.ForceAlong(m, d, t, Tendon(other, d, t).f - Tendon(m, d, t).f, force);
  for (const int k : difference.actuators)
    PullAlong(m, d, k, Actuator(other, d, k).f - Actuator(m, d, k).f, force);
  if (parts_.motion == 0) return;
  for (const auto& body : difference.bodies) {
    rigid_.AddBody(m, d, body.id, body.inertia.data(), -parts_.motion, force);
    if (beyond_) beyond_->AddBody(m, d, body.id, body.inertia.data(), parts_.motion, force);
  }
  if (difference.gravity) rigid_.AddGravity(m, other, parts_.motion, force);
}

}  // namespace continuum
