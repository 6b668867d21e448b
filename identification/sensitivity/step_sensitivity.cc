#include "identification/sensitivity/step_sensitivity.h"

#include <algorithm>
#include <utility>

#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Kind = Number::Kind;

// Euler takes only the damping of joints implicitly.
ForceDerivatives::Parts PartsOf(const mjModel& m) {
  ForceDerivatives::Parts parts;
  parts.all_felt = m.opt.integrator != mjINT_EULER;
  return parts;
}

}  // namespace

std::string StepSensitivity::Obstacle(const mjModel& m, const mjData& d, const Wiring& wiring) {
  const bool damped = m.opt.integrator == mjINT_EULER && !(m.opt.disableflags & mjDSBL_EULERDAMP);
  if (m.opt.integrator != mjINT_IMPLICITFAST && !damped)
    return "the integrator is neither implicitfast nor Euler";
  for (const std::string& why : {SolverRows::Obstacle(m), ForceDerivatives::Obstacle(m),
                                 SensorDerivatives::Obstacle(m, wiring)}) {
    if (!why.empty()) return why;
  }
  return EffectDerivatives::Obstacle(m, d);
}

StepSensitivity::StepSensitivity(const ModelAndData& machine, const Wiring& wiring,
                                 const std::vector<const ModelAndData*>& perturbed, double move)
    : move_(move),
      covered_(perturbed.size()),
      derivatives_(*machine.model, PartsOf(*machine.model)),
      sensors_(*machine.model, wiring),
      pull_(machine.model->ntendon),
      inertia_(machine.model->nv, machine.model->nv) {
  const mjModel& m = *machine.model;
  for (std::size_t k = 0; k < perturbed.size(); ++k) {
    ModelDifference difference(m, *perturbed[k]->model);
    covered_[k] = difference.field.empty();
    if (!covered_[k]) continue;
    difference.AddGated(wiring);
    columns_.push_back(k);
    perturbed_.push_back(perturbed[k]);
    differences_.push_back(std::move(difference));
  }
  const auto count = static_cast<Eigen::Index>(columns_.size());
  effects_.emplace(machine, perturbed_, move);
  rows_.emplace(m, perturbed_, move);
  numbers_.emplace(m, effects_->parameters(), count);
  effects_->WriteConstants(*numbers_);
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

// dE, and the levels of friction.
void StepSensitivity::FollowEffects(const mjModel& m, const mjData& d) {
  using Parts = ForceDerivatives::Parts;
  effects_->Update(m, d, z_.data(), q_after_.data(), after_.data());
  std::fill(pull_.begin(), pull_.end(), 0.0);
  effects_->AddPulls(pull_);
  Of(Kind::kForce).setZero(), Of(Kind::kPull).setZero();
  numbers_->SetRows(d.nefc);
  effects_->AddForces(*numbers_, false);
  if (effects_->Reads(Kind::kTorqueTransmitted)) {
    FollowLoad(m, d,
               Parts{.springs = -1, .dampers = 0, .actuators = 1, .motion = -1, .moves = false},
               Kind::kTorqueTransmitted);
    AddEffects(m, d, -1, Of(Kind::kTorqueTransmitted));
  }
  if (effects_->Reads(Kind::kTorqueActuator))
    FollowLoad(m, d, Parts{.springs = 0, .dampers = 0, .motion = 0}, Kind::kTorqueActuator);
  effects_->AddForces(*numbers_, true);
  effects_->AddLevels(*numbers_);
}

// What loads gears: some of the forces at the speeds of the state. That of effects is given.
void StepSensitivity::FollowLoad(const mjModel& m, const mjData& d,
                                 const ForceDerivatives::Parts& parts, Kind torque) {
  ForceDerivatives load(m, parts);
  load.Place(m, d);
  std::vector<double> pull = pull_;
  for (double& f : pull) f *= parts.springs;
  load.Pull(pull);
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
  if (factor_.info() != Eigen::Success) return false;
  factor_.solveInPlace(force);
  return true;
}

// df of (2).
bool StepSensitivity::FollowRows(const mjModel& m, const mjData& d) {
  Derive(m, d, d.qacc, d.qvel, answer_);
  rows_->Differentiate(m, d, derivatives_.tendons(), *numbers_);
  rows_->AddForces(m, d, Of(Kind::kPosition), answer_);
  mj_fullM(&m, &d, inertia_.data());
  rows_->AddInertia(m, d, inertia_);
  if (!Solve(answer_)) return false;  // da
  rows_->Follow(m, d, answer_);
  rows_->WriteYields(m, d, Of(Kind::kYield));
  return true;
}

void StepSensitivity::FollowLags(const mjModel& m, const mjData& d) {
  const double h = m.opt.timestep;
  for (int k = 0; k < m.nactuator; ++k) {
    const int w = m.actuator_actadr[k];
    if (w >= 0) activation_.row(w) *= NextActivation(m, d, k, h).by_itself;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (const int k : differences_[c].activations) {
      activation_(m.actuator_actadr[k], static_cast<Eigen::Index>(c)) +=
          (NextActivation(*perturbed_[c]->model, d, k, h).value -
           NextActivation(m, d, k, h).value) /
          move_;
    }
  }
}

// At the state of Before.
bool StepSensitivity::Follow(const mjModel& m, const mjData& d) {
  derivatives_.Place(m, d);
  FollowTendons(m, d);
  FollowEffects(m, d);
  rows_->AddPulls(d, pull_);
  derivatives_.Pull(pull_);
  if (!rows_->empty() && !FollowRows(m, d)) return false;
  Derive(m, d, a_.data(), after_.data(), force_);
  if (!rows_->empty()) rows_->AddForces(m, d, Of(Kind::kPosition), force_);
  mj_fullM(&m, &d, inertia_.data());
  inertia_ -= m.opt.timestep * derivatives_.damping();
  if (!Solve(force_)) return false;  // da*
  FollowLags(m, d);
  FollowStates(m);
  return true;
}

void StepSensitivity::FollowStates(const mjModel& m) {
  const double h = m.opt.timestep;
  Tangents &speed = Of(Kind::kSpeedAfter), &position = Of(Kind::kPositionAfter);
  speed = Of(Kind::kSpeed) + h * force_;
  position = Of(Kind::kPosition) + h * speed;
  Of(Kind::kNext).setZero();
  effects_->AddNext(*numbers_);
  Of(Kind::kSpeed).swap(speed), Of(Kind::kPosition).swap(position);
  Of(Kind::kState).swap(Of(Kind::kNext));
}

void StepSensitivity::SwapState(mjData& d) {
  std::swap_ranges(q_.begin(), q_.end(), d.qpos);
  std::swap_ranges(v_.begin(), v_.end(), d.qvel);
  std::swap_ranges(w_.begin(), w_.end(), d.act);
}

bool StepSensitivity::After(const mjModel& m, mjData& d) {
  q_after_.assign(d.qpos, d.qpos + m.nq), after_.assign(d.qvel, d.qvel + m.nv);
  a_.resize(m.nv);
  for (int i = 0; i < m.nv; ++i) a_[i] = (after_[i] - v_[i]) / m.opt.timestep;
  SwapState(d);  // it holds the step's forces already
  const bool followed = rows_->Find(m, d) && Follow(m, d);
  SwapState(d);
  return followed;
}

void StepSensitivity::Observe(const mjModel& m, mjData& d, std::size_t row,
                              std::span<Recorder> recorders) {
  sensors_.Update(m, d);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    const Eigen::VectorXd dq = move_ * Of(Kind::kPosition).col(column),
                          dv = move_ * Of(Kind::kSpeed).col(column);
    sensors_.Move(d, dq.data(), dv.data());
    recorders[columns_[c]].Take(d, row);
    sensors_.Back(d);
  }
}

}  // namespace continuum
