#include "identification/sensitivity/continuous_dynamics.h"

#include <algorithm>

#include "binding/cable_friction.h"
#include "binding/friction_row.h"
#include "engine.h"
#include "sim/model/effect_kind.h"
#include "sim/model/mujoco_handles.h"
#include "sim/simulation/initial_state.h"

namespace continuum {
namespace {

// MuJoCo's own; that of effects is a bristle.
std::string DryFriction(const mjModel& m) {
  for (int i = 0; i < m.nv; ++i) {
    if (m.dof_frictionloss[i] > kRowMarker)
      return "joint " + Called(m, mjOBJ_JOINT, m.dof_jntid[i]) + " has dry friction";
  }
  for (int i = 0; i < m.ntendon; ++i) {
    if (m.tendon_frictionloss[i] > kRowMarker)
      return "tendon " + Called(m, mjOBJ_TENDON, i) + " has dry friction";
  }
  return "";
}

std::string Delayed(const mjModel& m) {
  for (int i = 0; i < m.nu; ++i) {
    if (m.actuator_delay[i] > 0) return "actuator " + Called(m, mjOBJ_ACTUATOR, i) + " has a delay";
    if (m.actuator_actadr[i] >= 0 && m.actuator_actlimited[i])
      return "the activation of actuator " + Called(m, mjOBJ_ACTUATOR, i) + " is limited";
  }
  for (int i = 0; i < m.nsensor; ++i) {
    if (m.sensor_delay[i] > 0 || m.sensor_interval[2 * i] > 0)
      return "sensor " + Called(m, mjOBJ_SENSOR, i) + " has a delay";
  }
  return "";
}

std::string Switches(const mjModel& m, const mjData& d) {
  std::vector<double> rate(m.npluginstate);
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string name = mjp_getPluginAtSlot(m.plugin[i])->name;
    const std::string instance = name + " " + Called(m, mjOBJ_PLUGIN, i);
    if (!name.starts_with("continuum.")) return instance + " is not one of ours";
    const BoundLaw& law = BoundOf(m, d, i);
    const double* const z = d.plugin_state + m.plugin_stateadr[i];
    if (law.NeedsAllForces()) continue;  // as bristles, or while no cable is under tension
    if (law.IsRow()) {
      const std::string why = law.WhyNoBristles(m);
      if (why.empty()) continue;
      return instance + " has dry friction: " + why;
    }
    if (m.plugin_statenum[i] > 0 && !law.Rates(m, d, z, rate.data()))
      return instance + " has discrete states";
  }
  return "";
}

// ½ p ω of a quaternion p and an angular velocity in the axes of the body.
void Turn(const double* p, const double* w, double* rate) {
  const double half[4] = {0, 0.5 * w[0], 0.5 * w[1], 0.5 * w[2]};
  mju_mulQuat(rate, p, half);
}

// A motor that pulls nothing in a log: a force in proportion to a control that stays zero.
bool RestsAll(const mjModel& m, const Log& log, const Wiring& wiring, int actuator) {
  if (m.actuator_gaintype[actuator] != mjGAIN_FIXED ||
      m.actuator_biastype[actuator] != mjBIAS_NONE || m.actuator_dyntype[actuator] != mjDYN_NONE)
    return false;
  for (std::size_t i = 0; i < wiring.actuator.size(); ++i) {
    const auto& u = log.input[i];
    if (wiring.actuator[i] == actuator &&
        std::any_of(u.begin(), u.end(), [](double value) { return value != 0; }))
      return false;
  }
  return true;
}

// Whether no cable of a law is ever under tension, whatever the fit does: its contacts need no
// states.
bool AreSlack(const mjModel& m, const BoundLaw& law, const Experiment& e, const Log& log,
              const Wiring& wiring) {
  for (const Parameter& p : e.parameters)
    if (p.target.starts_with("tendon:") || p.target.starts_with("actuator:")) return false;
  const auto& cables = dynamic_cast<const CableFriction&>(law).cables();
  const auto none = [&](const mjtNum* linear, const mjtNum* more, int t) {
    return linear[t] == 0 && std::all_of(more + mjNPOLY * t, more + mjNPOLY * (t + 1),
                                         [](double value) { return value == 0; });
  };
  return std::all_of(cables.begin(), cables.end(), [&](const Cable& cable) {
    return none(m.tendon_stiffness, m.tendon_stiffnesspoly, cable.tendon) &&
           none(m.tendon_damping, m.tendon_dampingpoly, cable.tendon) &&
           std::all_of(cable.actuators.begin(), cable.actuators.end(), [&](int a) {
             return none(m.actuator_damping, m.actuator_dampingpoly, a) &&
                    RestsAll(m, log, wiring, a);
           });
  });
}

bool Jumps(const std::vector<double>& u, std::size_t row) { return u[row] != u[row - 1]; }

// A linear input is smooth where it goes on as it came.
bool Bends(const std::vector<double>& t, const std::vector<double>& u, std::size_t row) {
  if (row + 1 == u.size()) return false;
  const double before = (u[row] - u[row - 1]) / (t[row] - t[row - 1]);
  const double after = (u[row + 1] - u[row]) / (t[row + 1] - t[row]);
  return std::abs(after - before) > 1e-9 * (std::abs(after) + std::abs(before));
}

}  // namespace

bool BreaksAt(const Experiment& e, const Log& log, std::size_t row) {
  if (row == 0) return true;
  for (std::size_t i = 0; i < log.input.size(); ++i) {
    const auto& u = log.input[i];
    if (e.inputs[i].linear ? Bends(log.time, u, row) : Jumps(u, row)) return true;
    const auto& on = log.enable[i];
    if (!on.empty() && on[row] != on[row - 1]) return true;
  }
  return false;
}

std::string ContinuousDynamics::Obstacle(const mjModel& m, const mjData& d) {
  for (const std::string& why : {DryFriction(m), Delayed(m), Switches(m, d)}) {
    if (!why.empty()) return why;
  }
  return JointEqualities(m).obstacle();
}

ContinuousDynamics::ContinuousDynamics(ModelAndData machine, const Experiment& e, const Log& log)
    : machine_(std::move(machine)),
      log_(log),
      wiring_(e, *machine_.model),
      ties_(*machine_.model),
      inputs_(*machine_.model, e, log, wiring_) {
  mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  const InitialState start = StartOf(machine_, e, log);
  m.opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_AUTORESET;
  std::fill_n(m.actuator_actearly, m.nu, mjtByte{0});  // there are no steps to be early by
  if (m.opt.integrator == mjINT_DISCRETE) m.opt.integrator = mjINT_EULER;  // its forces know h
  mj_resetData(&m, &d);
  inputs_.AtRow(d, 0);
  Settle(m, d);
  start_.resize(ties_.positions() + ties_.velocities());
  ties_.FreePositions(start.qpos.data(), start_.data());
  ties_.FreeVelocities(start.qvel.data(), start_.data() + ties_.positions());
  moving_.resize(m.nq);
  start_.insert(start_.end(), d.act, d.act + m.na);
  TakeCables(e);
  FindStates();
  for (const int z : states_) start_.push_back(d.plugin_state[z]);
  for (const Input& in : e.inputs) linear_ |= in.linear;
  for (const auto& source : wiring_.output) {
    if (source.kind != Output::Kind::kSensor) {
      needs_ = Needs::kAll;
      continue;
    }
    needs_ = std::max(needs_, NeedsOf(m, source.sensor));
  }
}

ContinuousDynamics::Needs ContinuousDynamics::NeedsOf(const mjModel& m, int sensor) {
  switch (m.sensor_type[sensor]) {
    case mjSENS_JOINTPOS:
    case mjSENS_JOINTVEL:
      return Needs::kState;
    case mjSENS_FRAMEPOS:
    case mjSENS_FRAMEQUAT:
    case mjSENS_FRAMEXAXIS:
    case mjSENS_FRAMEYAXIS:
    case mjSENS_FRAMEZAXIS:
      return Needs::kFrames;
    case mjSENS_PLUGIN:
      return Needs::kAll;
    default:
      return m.sensor_needstage[sensor] == mjSTAGE_POS ? Needs::kPosition : Needs::kAll;
  }
}

void ContinuousDynamics::Hold(std::size_t row) {
  row_ = row;
  inputs_.AtRow(*machine_.data, row);
}

void ContinuousDynamics::Load(const double* y) {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  ties_.Spread(m, y, y + ties_.positions(), d);
  std::copy_n(y += ties_.positions() + ties_.velocities(), m.na, d.act);
  y += m.na;
  for (std::size_t i = 0; i < states_.size(); ++i) d.plugin_state[states_[i]] = y[i];
}

void ContinuousDynamics::Rate(double t, const double* y, double* rate) {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  Load(y);
  if (linear_ && row_ + 1 < log_.rows()) inputs_.Interpolate(d, row_, t);
  mj_forwardSkip(&m, &d, mjSTAGE_NONE, 1);
  Complete();
  for (int j = 0; j < m.njnt; ++j) {
    const int q = m.jnt_qposadr[j], v = m.jnt_dofadr[j];
    switch (m.jnt_type[j]) {
      case mjJNT_FREE:
        std::copy_n(d.qvel + v, 3, &moving_[q]);
        Turn(d.qpos + q + 3, d.qvel + v + 3, &moving_[q + 3]);
        break;
      case mjJNT_BALL:
        Turn(d.qpos + q, d.qvel + v, &moving_[q]);
        break;
      default:
        moving_[q] = d.qvel[v];
    }
  }
  ties_.FreePositions(moving_.data(), rate);
  ties_.FreeVelocities(d.qacc, rate += ties_.positions());
  std::copy_n(d.act_dot, m.na, rate += ties_.velocities());
  rate += m.na;
  for (std::size_t i = 0; i < states_.size(); ++i) rate[i] = state_rate_[states_[i]];
}

void ContinuousDynamics::FindStates() {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  state_rate_.resize(m.npluginstate), friction_.resize(m.nv), friction_rate_.resize(m.nv);
  for (int i = 0; i < m.nplugin; ++i) {
    const BoundLaw& law = BoundOf(m, d, i);
    const int first = m.plugin_stateadr[i];
    const auto taken = [i](const CableLaw& cable) { return cable.instance == i; };
    const bool cables = std::any_of(cables_.begin(), cables_.end(), taken);
    if (law.NeedsAllForces() && !cables) continue;
    if (cables || law.IsRow()) {
      rubs_ = true;
      for (const int z : law.BristleStates())
        states_.push_back(first + z), d.plugin_state[first + z] = 0;
    } else {
      for (int z = 0; z < m.plugin_statenum[i]; ++z) states_.push_back(first + z);
    }
  }
}

// From here on the forward pass knows no friction of cables.
void ContinuousDynamics::TakeCables(const Experiment& e) {
  mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  for (int i = 0; i < m.nplugin; ++i) {
    const BoundLaw& law = BoundOf(m, d, i);
    if (!law.NeedsAllForces() || !law.WhyNoBristles(m).empty() ||
        AreSlack(m, law, e, log_, wiring_))
      continue;
    cables_.push_back({i, law.parameters()});
    SetParameters(m, d, i, FrictionlessPath(m, i));
  }
}

// Loads on gears see it as they do in steps.
void ContinuousDynamics::AddCables() {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  for (CableLaw& cable : cables_) {
    BoundLaw& law = BoundOf(m, d, cable.instance);
    const int first = m.plugin_stateadr[cable.instance];
    std::vector<double> none = law.parameters();
    law.Set(cable.parameters);
    law.Bristles(m, d, d.plugin_state + first, state_rate_.data() + first, friction_);
    law.Set(std::move(none));
  }
  if (!cables_.empty()) mju_addTo(d.qfrc_passive, friction_.data(), static_cast<int>(m.nv));
}

// Sensors of their tensions, which the forward pass has without friction.
void ContinuousDynamics::SenseCables() {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  for (const CableLaw& cable : cables_) {
    const BoundLaw& law = BoundOf(m, d, cable.instance);
    for (int s = 0; s < m.nsensor; ++s) {
      if (m.sensor_type[s] == mjSENS_PLUGIN && m.sensor_plugin[s] == cable.instance)
        law.Sense(m, d, s, {d.sensordata + m.sensor_adr[s], std::size_t(m.sensor_dim[s])});
    }
  }
}

// What a forward pass does not know: rates of effects, dry friction, joints that are tied.
void ContinuousDynamics::Complete() {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  std::fill(friction_.begin(), friction_.end(), 0.0);
  AddCables();
  for (int i = 0; i < m.nplugin; ++i) {
    const BoundLaw& law = BoundOf(m, d, i);
    const double* const z = d.plugin_state + m.plugin_stateadr[i];
    double* const rate = state_rate_.data() + m.plugin_stateadr[i];
    if (law.IsRow()) law.Bristles(m, d, z, rate, friction_);
    if (!law.IsRow() && !law.NeedsAllForces()) law.Rates(m, d, z, rate);
  }
  if (rubs_) {
    mj_solveM(&m, &d, friction_rate_.data(), friction_.data(), 1);
    mju_addTo(d.qfrc_smooth, friction_.data(), static_cast<int>(m.nv));
    mju_addTo(d.qacc_smooth, friction_rate_.data(), static_cast<int>(m.nv));
    mju_copy(d.qacc, d.qacc_smooth, static_cast<int>(m.nv));
  }
  if (!ties_.none()) ties_.Accelerate(m, d);
}

void ContinuousDynamics::Observe(const double* y, Recorder& recorder) {
  const mjModel& m = *machine_.model;
  mjData& d = *machine_.data;
  Load(y);
  if (linear_) inputs_.AtRow(d, row_);
  if (needs_ == Needs::kAll) {
    mj_forward(&m, &d);
    if (rubs_ || !ties_.none()) {  // sensors of acceleration and of forces between bodies
      Complete();
      mj_rnePostConstraint(&m, &d);
      mj_sensorAcc(&m, &d);
      SenseCables();
    }
  } else {
    if (needs_ >= Needs::kFrames) mj_kinematics(&m, &d);
    if (needs_ >= Needs::kPosition) {
      mj_comPos(&m, &d);
      mj_tendon(&m, &d);
      mj_transmission(&m, &d);
    }
    mj_sensorPos(&m, &d);
    mj_sensorVel(&m, &d);
  }
  Record(recorder);
}

}  // namespace continuum
