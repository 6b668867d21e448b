#include "sim/simulation/force_probe.h"

#include "sim/simulation/initial_state.h"

namespace continuum {

using Eigen::VectorXd;

ForceProbe::ForceProbe(mjModel& m, mjData& d, const Hooks* hooks)
    : m_(m),
      d_(d),
      hooks_(hooks && hooks->step ? hooks : nullptr),
      flags_(m.opt.disableflags),
      state_(StateOf(m, d, mjSTATE_INTEGRATION)) {
  m.opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_SENSOR;
}

ForceProbe::~ForceProbe() {
  m_.opt.disableflags = flags_;
  mj_setState(&m_, &d_, state_.data(), mjSTATE_INTEGRATION);
}

VectorXd ForceProbe::Moved(const VectorXd& step) {
  Restore();
  mj_integratePos(&m_, d_.qpos, step.data(), 1);
  return Force();
}

VectorXd ForceProbe::Moving(int dof, double speed) {
  Restore();
  d_.qvel[dof] = speed;
  return Force();
}

void ForceProbe::Restore() {
  mj_setState(&m_, &d_, state_.data(), mjSTATE_INTEGRATION);
  mju_zero(d_.qvel, static_cast<int>(m_.nv));
}

// Passive forces as they are before actuators are known: the friction of a cable keeps its share
// there, while at rest it would answer every push.
VectorXd ForceProbe::Force() {
  if (hooks_) {
    mju_zero(d_.qfrc_applied, static_cast<int>(m_.nv));
    hooks_->step(m_, d_);
  }
  mj_fwdPosition(&m_, &d_);
  mj_fwdVelocity(&m_, &d_);
  const VectorXd passive = VectorXd::Map(d_.qfrc_passive, m_.nv);
  mj_fwdActuation(&m_, &d_);
  const auto of = [&](const double* f) { return VectorXd::Map(f, m_.nv); };
  return passive + of(d_.qfrc_actuator) + of(d_.qfrc_applied) - of(d_.qfrc_bias);
}

}  // namespace continuum
