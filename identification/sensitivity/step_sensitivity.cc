#include "identification/sensitivity/step_sensitivity.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "identification/sensitivity/native_forces.h"
#include "mujoco_compat.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Kind = Number::Kind;
using Implicit = ForceDerivatives::Implicit;

ForceDerivatives::Parts PartsOf(Implicit implicit) {
  ForceDerivatives::Parts parts;
  parts.implicit = implicit;
  return parts;
}

// Friction of cables knows no derivatives of the motion's forces (step_inertia.h).
ForceDerivatives::Parts PartsOfCables(const mjModel& m) {
  return PartsOf(std::min(ForceDerivatives::ImplicitOf(m), Implicit::kForces));
}

// What loads gears: actuators less springs and weight (gear_load.h); actuators alone.
constexpr ForceDerivatives::Parts kTransmitted{
    .springs = -1, .dampers = 0, .motion = -1, .moves = false};
constexpr ForceDerivatives::Parts kMotors{.springs = 0, .dampers = 0, .motion = 0};

// Of a history that holds its samples nothing moves until the delay has moved by one.
bool DelayIsInSamples(const mjModel& m, const mjModel& other) {
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_delay[a] != other.actuator_delay[a] && m.actuator_history[2 * a + 1] == 0)
      return true;
  }
  return false;
}

std::string NoColumn(const ModelDifference& difference, const mjModel& m, const mjModel& other) {
  if (!difference.alike) return "it changes a size of the model (" + difference.field + ")";
  return DelayIsInSamples(m, other) ? "the history holds samples: a delay counts whole ones" : "";
}

}  // namespace

std::string StepSensitivity::Obstacle(const mjModel& m, const mjData& d, const Wiring& wiring) {
  if (IsDiscrete(m)) return "the integrator is discrete";
  for (const std::string& why : {SolverRows::Obstacle(m), ForceDerivatives::Obstacle(m),
                                 SensorDerivatives::Obstacle(m, wiring)}) {
    if (!why.empty()) return why;
  }
  if (ForceDerivatives::ImplicitOf(m) >= ForceDerivatives::Implicit::kForces) {
    if (auto why = TendonDerivatives::DampingObstacle(m); !why.empty()) return why;
  }
  return EffectDerivatives::Obstacle(m, d);
}

StepSensitivity::StepSensitivity(const ModelAndData& machine, const Wiring& wiring,
                                 const std::vector<const ModelAndData*>& perturbed, double move,
                                 const std::vector<const ModelAndData*>& mirrored)
    : move_(move),
      why_not_(perturbed.size()),
      steps_(move),
      derivatives_(*machine.model, PartsOf(ForceDerivatives::ImplicitOf(*machine.model))),
      transmitted_(*machine.model, kTransmitted),
      motors_(*machine.model, kMotors),
      sensors_(*machine.model, wiring),
      pull_(machine.model->ntendon),
      inertia_(machine.model->nv, machine.model->nv) {
  const mjModel& m = *machine.model;
  if (!SensorDerivatives::Cover(m, wiring)) moved_sensors_.emplace(m, move);
  for (std::size_t k = 0; k < perturbed.size(); ++k) {
    ModelDifference difference(m, *perturbed[k]->model);
    why_not_[k] = NoColumn(difference, m, *perturbed[k]->model);
    if (!Covers(k)) continue;
    const bool known = difference.field.empty();
    if (!known)
      steps_.Add(*perturbed[k], mirrored.empty() ? nullptr : mirrored[k], std::ssize(columns_));
    difference.AddGated(wiring);
    columns_.push_back(k);
    if (moved_sensors_) moved_sensors_->Add(*perturbed[k]);
    perturbed_.push_back(known ? perturbed[k] : &machine);
    differences_.push_back(known ? std::move(difference) : ModelDifference(m, m));
  }
  const auto count = static_cast<Eigen::Index>(columns_.size());
  effects_.emplace(machine, perturbed_, move);
  rows_.emplace(m, perturbed_, move);
  numbers_.emplace(m, effects_->parameters(), count);
  effects_->WriteConstants(*numbers_);
  if (effects_->uses_actuators()) {
    actuators_.emplace(machine, perturbed_, move);
    actuators_->WriteConstants(*numbers_);
  }
  if (effects_->Cable(m, *machine.data, nullptr).law) cable_.emplace(m, PartsOfCables(m));
  if (m.opt.integrator == mjINT_RK4) stages_.emplace(machine);
  activation_.setZero(m.na, count);
  force_.setZero(m.nv, count), answer_ = force_, differ_ = force_;
}

void StepSensitivity::Start(std::size_t k, const State& difference) {
  const auto c = std::find(columns_.begin(), columns_.end(), k) - columns_.begin();
  const auto write = [c](const std::vector<double>& from, Tangents& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to(static_cast<Eigen::Index>(i), c) = from[i];
  };
  write(difference.q, Of(Kind::kPosition)), write(difference.v, Of(Kind::kSpeed));
  write(difference.w, activation_), write(difference.z, Of(Kind::kState));
}

void StepSensitivity::Before(const mjModel& m, const mjData& d) {
  q_.assign(d.qpos, d.qpos + m.nq), v_.assign(d.qvel, d.qvel + m.nv);
  w_.assign(d.act, d.act + m.na), z_.assign(d.plugin_state, d.plugin_state + m.npluginstate);
  u_ = ControlsMet(m, d);
  steps_.Keep(m, d);
  if (stages_) stages_->Keep(m, d);
}

void StepSensitivity::FollowTendons(const mjModel& m, const mjData& d) {
  Tangents &length = Of(Kind::kLength), &rate = Of(Kind::kRate);
  for (int t = 0; t < m.ntendon; ++t) {
    length.row(t).setZero(), rate.row(t).setZero();
    std::vector<double> bend(m.nv, 0);
    derivatives_.tendons().AddBend(t, 1, d.qvel, bend);
    const int adr = m.ten_J_rowadr[t];
    for (int k = adr; k < adr + m.ten_J_rownnz[t]; ++k) {
      const int dof = m.ten_J_colind[k];
      length.row(t) += d.ten_J[k] * Of(Kind::kPosition).row(dof);
      rate.row(t) += d.ten_J[k] * Of(Kind::kSpeed).row(dof);
    }
    for (int i = 0; i < m.nv; ++i) {
      if (bend[i] != 0) rate.row(t) += bend[i] * Of(Kind::kPosition).row(i);
    }
  }
}

StepTaken StepSensitivity::Taken() {
  StepTaken taken{z_.data(), q_after_.data(), after_.data()};
  if (!actuators_) return taken;
  taken.control = actuators_->control().data();
  taken.input = actuators_->input().data(), taken.force = actuators_->force().data();
  return taken;
}

// From controls to what actuators give, with signals between them.
bool StepSensitivity::FollowActuators(const mjModel& m, mjData& d) {
  using Group = EffectDerivatives::Group;
  actuators_->Begin(m, d, *numbers_);
  effects_->Update(Group::kInputs, m, d, Taken());
  effects_->AddSignals(Group::kInputs, *numbers_);
  if (!actuators_->SetInputs(m, d, activation_, *numbers_))
    return Fail("a signal is outside of the range of its control");
  effects_->Update(Group::kDrives, m, d, Taken());
  effects_->AddSignals(Group::kDrives, *numbers_);
  actuators_->Limit(m, *numbers_);
  given_ = actuators_->force();
  effects_->KeepGiven(given_);
  derivatives_.Give(given_);
  return true;
}

// dE, and the levels of friction.
bool StepSensitivity::FollowEffects(const mjModel& m, mjData& d) {
  if (actuators_ && !FollowActuators(m, d)) return false;
  effects_->Update(EffectDerivatives::Group::kOthers, m, d, Taken());
  std::fill(pull_.begin(), pull_.end(), 0.0);
  effects_->AddPulls(pull_);
  Of(Kind::kForce).setZero(), Of(Kind::kPull).setZero();
  numbers_->SetRows(d.nefc);
  effects_->AddForces(*numbers_, false);
  if (effects_->Reads(Kind::kTorqueTransmitted)) {
    FollowLoad(m, d, Kind::kTorqueTransmitted);
    AddEffects(m, d, -1, Of(Kind::kTorqueTransmitted));
  }
  if (effects_->Reads(Kind::kTorqueActuator)) FollowLoad(m, d, Kind::kTorqueActuator);
  effects_->AddForces(*numbers_, true);
  if (cable_) FollowCable(m, d);
  effects_->AddLevels(*numbers_);
  return true;
}

// Friction of cables sees all other forces but those of the solver.
void StepSensitivity::FollowCable(const mjModel& m, const mjData& d) {
  const CableDerivatives::Law law = effects_->Cable(m, d, z_.data());
  const auto follow_others = [&] {
    answer_.setZero();
    if (!cable_->rests()) return;
    Differ(m, d, cable_->derivatives(), answer_);
    AddEffects(m, d, 1, answer_);
  };
  if (!law.law->sliding().turn().bends.empty()) {
    cable_->BeginTurn(m, d, law, pull_, given_);
    follow_others();
    cable_->FollowTurn(m, d, *numbers_, answer_);
  }
  cable_->Begin(m, d, law, pull_, given_);
  follow_others();
  const Tangents& more = cable_->Follow(m, d, *numbers_, answer_);
  Of(Kind::kForce) += more, Of(Kind::kTorqueTransmitted) -= more;
}

// What loads gears: some of the forces at the speeds of the state. That of effects is given.
void StepSensitivity::FollowLoad(const mjModel& m, const mjData& d, Kind torque) {
  ForceDerivatives& load = torque == Kind::kTorqueActuator ? motors_ : transmitted_;
  load.Place(m, d);
  std::vector<double> pull = pull_;
  for (double& f : pull) f *= load.parts().springs;
  load.Pull(pull);
  if (actuators_) load.Give(given_);
  load.Update(m, d, a_.data(), d.qvel, m.opt.timestep);
  Differ(m, d, load, Of(torque));
}

// force += factor dE.
void StepSensitivity::AddEffects(const mjModel& m, const mjData& d, double factor,
                                 Tangents& force) const {
  force += factor * Of(Kind::kForce);
  for (int t = 0; t < m.ntendon; ++t) {
    const int adr = m.ten_J_rowadr[t];
    for (int k = adr; k < adr + m.ten_J_rownnz[t]; ++k)
      force.row(m.ten_J_colind[k]) += factor * d.ten_J[k] * Of(Kind::kPull).row(t);
  }
}

// dF where derivatives stand, of every covered perturbed model.
void StepSensitivity::Differ(const mjModel& m, const mjData& d, const ForceDerivatives& derivatives,
                             Tangents& force) {
  differ_.setZero();
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    derivatives.Differ(m, d, *perturbed_[c]->model, differences_[c],
                       differ_.col(static_cast<Eigen::Index>(c)).data());
  }
  force = differ_ / move_;
  force.noalias() += derivatives.by_position() * Of(Kind::kPosition);
  force.noalias() += derivatives.by_velocity() * Of(Kind::kSpeed);
  if (m.na > 0) force.noalias() += derivatives.by_activation() * activation_;
  if (actuators_)
    actuators_->AddForces(m, d, given_, derivatives.parts().actuators, *numbers_, force);
}

// dF + dE at the accelerations a and the speeds felt.
void StepSensitivity::Derive(const mjModel& m, const mjData& d, const double* a, const double* felt,
                             Tangents& force) {
  derivatives_.Update(m, d, a, felt, m.opt.timestep);
  Differ(m, d, derivatives_, force);
  AddEffects(m, d, 1, force);
}

bool StepSensitivity::Solve(Tangents& force) {
  factor_.compute(inertia_);
  if (factor_.info() != Eigen::Success) return Fail("the step's matrix is not positive definite");
  factor_.solveInPlace(force);
  return true;
}

bool StepSensitivity::Fail(std::string why) {
  failure_ = std::move(why);
  return false;
}

// df of (2).
bool StepSensitivity::FollowRows(const mjModel& m, const mjData& d) {
  Derive(m, d, d.qacc, d.qvel, answer_);
  rows_->Differentiate(m, d, derivatives_.tendons(), *numbers_);
  rows_->AddForces(d, Of(Kind::kPosition), answer_);
  mj_fullM(&m, &d, inertia_.data());
  rows_->AddInertia(d, inertia_);
  if (!Solve(answer_)) return false;  // da
  rows_->Follow(d, answer_);
  rows_->WriteYields(m, d, Of(Kind::kYield));
  return true;
}

// dẇ where derivatives stand.
Tangents StepSensitivity::RateOfActivations(const mjModel& m, const mjData& d) const {
  Tangents rates = Tangents::Zero(activation_.rows(), activation_.cols());
  for (int k = 0; k < m.nactuator; ++k) {
    const int w = m.actuator_actadr[k];
    if (w < 0) continue;
    const Activation rate = RateOfActivation(m, d, k);
    rates.row(w) = rate.by_itself * activation_.row(w);
    if (actuators_) rates.row(w) += rate.by_input * Of(Kind::kInput).row(k);
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (const int k : differences_[c].activations) {
      const double there = RateOfActivation(*perturbed_[c]->model, d, k).value;
      rates(m.actuator_actadr[k], static_cast<Eigen::Index>(c)) +=
          (there - RateOfActivation(m, d, k).value) / move_;
    }
  }
  return rates;
}

// w⁺ = w + s ẇ, with s of ActivationSpan and the step's mean rate.
void StepSensitivity::FollowActivations(const mjModel& m, const Tangents& rates) {
  for (int k = 0; k < m.nactuator; ++k) {
    const int w = m.actuator_actadr[k];
    if (w >= 0) activation_.row(w) += ActivationSpan(m, k, m.opt.timestep) * rates.row(w);
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (const int k : differences_[c].activations) {
      const int w = m.actuator_actadr[k];
      const double here = ActivationSpan(m, k, m.opt.timestep),
                   there = ActivationSpan(*perturbed_[c]->model, k, m.opt.timestep);
      activation_(w, static_cast<Eigen::Index>(c)) += (there / here - 1) * w_change_[w] / move_;
    }
  }
}

// da*, from which all else follows.
bool StepSensitivity::FollowForces(const mjModel& m, mjData& d) {
  derivatives_.Place(m, d);
  FollowTendons(m, d);
  if (!rows_->Find(m, d)) return Fail("a contact acts");
  if (!FollowEffects(m, d)) return false;
  rows_->AddPulls(d, pull_);
  derivatives_.Pull(pull_);
  if (!rows_->empty() && !FollowRows(m, d)) return false;
  return FollowMethod(m, d);
}

// The second equation of (2).
bool StepSensitivity::FollowMethod(const mjModel& m, const mjData& d) {
  const Implicit implicit = derivatives_.parts().implicit;
  if (implicit == Implicit::kNothing && !rows_->empty()) {  // it is the first one
    force_ = answer_;
    return true;
  }
  Derive(m, d, a_.data(), after_.data(), force_);
  if (!rows_->empty()) rows_->AddForces(d, Of(Kind::kPosition), force_);
  mj_fullM(&m, &d, inertia_.data());
  inertia_ -= m.opt.timestep * derivatives_.damping();
  if (implicit != Implicit::kMotion) return Solve(force_);
  force_ = inertia_.partialPivLu().solve(force_);
  return force_.allFinite() || Fail("the step's matrix is singular");
}

// At the state of Before: q̇⁺ and q⁺ of (1), and activations.
bool StepSensitivity::FollowStep(const mjModel& m, mjData& d) {
  const bool followed = FollowForces(m, d);
  if (followed) FollowActivations(m, RateOfActivations(m, d));
  if (actuators_) actuators_->PutControlsBack(d);
  if (!followed) return false;
  const double h = m.opt.timestep;
  Tangents& speed = Of(Kind::kSpeedAfter);
  speed = Of(Kind::kSpeed) + h * force_;
  Of(Kind::kPositionAfter) = Of(Kind::kPosition) + h * speed;
  Advance(m, d);
  return true;
}

// (1) and (2) of RungeKuttaStages.
bool StepSensitivity::FollowStages(const mjModel& m) {
  using Stages = RungeKuttaStages;
  Tangents &q = Of(Kind::kPosition), &v = Of(Kind::kSpeed), &w = activation_;
  const Tangents q_start = q, v_start = v, w_start = w;
  Tangents &q_after = Of(Kind::kPositionAfter) = q, &v_after = Of(Kind::kSpeedAfter) = v;
  Tangents rate = Tangents::Zero(w.rows(), w.cols()), mean = rate;
  for (std::size_t i = 0; i < Stages::kReach.size(); ++i) {
    const double reach = Stages::kReach[i] * m.opt.timestep,
                 weight = Stages::kWeight[i] * m.opt.timestep;
    if (i > 0) q = q_start + reach * v, v = v_start + reach * force_, w = w_start + reach * rate;
    mjData& d = stages_->Evaluate(m, i);
    a_.assign(d.qacc, d.qacc + m.nv);
    const bool followed = FollowForces(m, d);
    if (followed) rate = RateOfActivations(m, d);
    if (actuators_) actuators_->PutControlsBack(d);
    if (!followed) return false;
    q_after += weight * v, v_after += weight * force_, mean += Stages::kWeight[i] * rate;
    if (i + 1 == Stages::kReach.size()) Advance(m, d);
  }
  w = w_start;
  FollowActivations(m, mean);
  return true;
}

// What only the step as a whole changes: states of effects.
void StepSensitivity::Advance(const mjModel& m, const mjData& d) {
  Of(Kind::kNext).setZero();
  effects_->AddNext(*numbers_);
  if (cable_) {
    answer_.setZero();
    rows_->AddConstraint(m, d, derivatives_.tendons(), Of(Kind::kPosition), answer_);
    cable_->AddNext(m, answer_, *numbers_);
  }
  Of(Kind::kSpeed).swap(Of(Kind::kSpeedAfter));
  Of(Kind::kPosition).swap(Of(Kind::kPositionAfter));
  Of(Kind::kState).swap(Of(Kind::kNext));
}

void StepSensitivity::SwapState(mjData& d) {
  std::swap_ranges(q_.begin(), q_.end(), d.qpos);
  std::swap_ranges(v_.begin(), v_.end(), d.qvel);
  std::swap_ranges(w_.begin(), w_.end(), d.act);
  std::swap_ranges(u_.begin(), u_.end(), d.ctrl);
}

bool StepSensitivity::After(const mjModel& m, mjData& d) {
  q_after_.assign(d.qpos, d.qpos + m.nq), after_.assign(d.qvel, d.qvel + m.nv);
  w_change_.assign(d.act, d.act + m.na);
  for (int i = 0; i < m.na; ++i) w_change_[i] -= w_[i];
  a_.resize(m.nv);
  for (int i = 0; i < m.nv; ++i) a_[i] = (after_[i] - v_[i]) / m.opt.timestep;
  steps_.Take(m, d);
  bool followed = false;
  if (stages_) {
    followed = FollowStages(m);
  } else {
    SwapState(d);  // it holds the step's forces already
    followed = FollowStep(m, d);
    SwapState(d);
  }
  steps_.AddTo(*numbers_, activation_);
  if (!followed) failure_ += fmt::format(" at {:g} s", d.time);
  return followed;
}

void StepSensitivity::Observe(const mjModel& m, mjData& d, std::size_t row,
                              std::span<Recorder> recorders) {
  if (moved_sensors_) {
    moved_sensors_->At(m, d);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      moved_sensors_->Observe(m, *numbers_, activation_, static_cast<Eigen::Index>(c), row,
                              recorders[columns_[c]]);
    return;
  }
  sensors_.Update(m, d);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    const Eigen::VectorXd dq = move_ * Of(Kind::kPosition).col(column),
                          dv = move_ * Of(Kind::kSpeed).col(column);
    sensors_.Move(d, dq.data(), dv.data());
    if (const mjData* there = steps_.Pose(m, d, column)) sensors_.MoveFrames(m, d, *there);
    recorders[columns_[c]].Take(d, row);
    sensors_.Back(d);
  }
}

}  // namespace continuum
