#include "identification/sensitivity/step_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {

std::string StepSensitivity::Obstacle(const mjModel& m, const Wiring& wiring) {
  if (m.nplugin > 0) return "an effect acts";
  if (m.opt.integrator != mjINT_IMPLICITFAST) return "the integrator is not implicitfast";
  if (m.neq > 0) return "there are equalities";
  if (m.opt.noslip_iterations > 0) return "the solver has steps against slip";
  const std::string why = ForceDerivatives::Obstacle(m);
  return why.empty() ? SensorDerivatives::Obstacle(m, wiring) : why;
}

StepSensitivity::StepSensitivity(const mjModel& m, const Wiring& wiring,
                                 std::vector<const mjModel*> perturbed, double move)
    : perturbed_(std::move(perturbed)),
      move_(move),
      covered_(perturbed_.size()),
      derivatives_(m),
      sensors_(m, wiring) {
  for (std::size_t k = 0; k < perturbed_.size(); ++k) {
    ModelDifference difference(m, *perturbed_[k]);
    covered_[k] = difference.field.empty();
    if (!covered_[k]) continue;
    difference.AddGated(wiring);
    columns_.push_back(k);
    differences_.push_back(std::move(difference));
  }
  const auto count = static_cast<Eigen::Index>(columns_.size());
  dq_ = dv_ = Matrix::Zero(m.nv, count);
  dw_ = Matrix::Zero(m.na, count);
  inertia_.resize(m.nv, m.nv);
}

void StepSensitivity::Start(std::size_t k, const std::vector<double>& dq,
                            const std::vector<double>& dv, const std::vector<double>& dw) {
  const auto c = std::find(columns_.begin(), columns_.end(), k) - columns_.begin();
  std::copy(dq.begin(), dq.end(), dq_.col(c).data());
  std::copy(dv.begin(), dv.end(), dv_.col(c).data());
  std::copy(dw.begin(), dw.end(), dw_.col(c).data());
}

void StepSensitivity::Before(const mjModel& m, const mjData& d) {
  q_.assign(d.qpos, d.qpos + m.nq), v_.assign(d.qvel, d.qvel + m.nv);
  w_.assign(d.act, d.act + m.na);
}

// A row at rest gives less than its level.
bool StepSensitivity::FindRows(const mjData& d) {
  friction_rows_.clear();
  for (int r = 0; r < d.nefc; ++r) {
    if (d.efc_type[r] != mjCNSTR_FRICTION_DOF) return false;
    const bool slides = std::abs(d.efc_force[r]) >= d.efc_frictionloss[r] * (1 - 1e-9);
    friction_rows_.push_back({r, d.efc_id[r], slides});
  }
  return true;
}

// dF at the accelerations a and the speeds felt, of every covered perturbed model.
void StepSensitivity::Derive(const mjModel& m, const mjData& d, const double* a, const double* felt,
                             Matrix& force) {
  derivatives_.Update(m, d, a, felt, m.opt.timestep);
  force = Matrix::Zero(m.nv, static_cast<Eigen::Index>(columns_.size()));
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    derivatives_.Differ(m, d, *perturbed_[columns_[c]], differences_[c],
                        force.col(static_cast<Eigen::Index>(c)).data());
  }
  force /= move_;
  force.noalias() += derivatives_.by_position() * dq_;
  force.noalias() += derivatives_.by_velocity() * dv_;
  if (m.na > 0) force.noalias() += derivatives_.by_activation() * dw_;
}

// df of (2).
bool StepSensitivity::AddFriction(const mjModel& m, const mjData& d, Matrix& force) {
  Derive(m, d, d.qacc, d.qvel, answer_);
  mj_fullM(&m, &d, inertia_.data());
  work_ = Matrix::Zero(answer_.rows(), answer_.cols());  // what f changes by itself
  for (const FrictionRow& row : friction_rows_) {
    const int i = row.dof;
    const double stiff = d.efc_D[row.row];
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const mjModel& other = *perturbed_[columns_[c]];
      double& change = work_(i, static_cast<Eigen::Index>(c));
      if (row.slides) {
        const double level = (other.dof_frictionloss[i] - m.dof_frictionloss[i]) / move_;
        change = std::copysign(level, d.efc_force[row.row]);
      } else {
        const double eased = other.dof_invweight0[i] / m.dof_invweight0[i] - 1;  // of R
        change = -stiff * d.efc_KBIP[4 * row.row + 1] * dv_(i, static_cast<Eigen::Index>(c)) -
                 d.efc_force[row.row] * eased / move_;
      }
    }
    if (!row.slides) inertia_(i, i) += stiff;
  }
  answer_ += work_;
  factor_.compute(inertia_);
  if (factor_.info() != Eigen::Success) return false;
  factor_.solveInPlace(answer_);  // da
  force += work_;
  for (const FrictionRow& row : friction_rows_) {
    if (!row.slides) force.row(row.dof) -= d.efc_D[row.row] * answer_.row(row.dof);
  }
  return true;
}

void StepSensitivity::FollowLags(const mjModel& m, const mjData& d) {
  const double h = m.opt.timestep;
  for (int k = 0; k < m.nactuator; ++k) {
    const int w = m.actuator_actadr[k];
    if (w >= 0) dw_.row(w) *= NextActivation(m, d, k, h).by_itself;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const mjModel& other = *perturbed_[columns_[c]];
    for (const int k : differences_[c].activations) {
      dw_(m.actuator_actadr[k], static_cast<Eigen::Index>(c)) +=
          (NextActivation(other, d, k, h).value - NextActivation(m, d, k, h).value) / move_;
    }
  }
}

// At the state of Before.
bool StepSensitivity::Follow(const mjModel& m, const mjData& d) {
  const double h = m.opt.timestep;
  Derive(m, d, a_.data(), after_.data(), force_);
  const Matrix damping = derivatives_.damping();
  if (!friction_rows_.empty() && !AddFriction(m, d, force_)) return false;
  mj_fullM(&m, &d, inertia_.data());
  inertia_ -= h * damping;
  factor_.compute(inertia_);
  if (factor_.info() != Eigen::Success) return false;
  factor_.solveInPlace(force_);  // da*
  FollowLags(m, d);
  dv_ += h * force_;
  dq_ += h * dv_;
  return true;
}

void StepSensitivity::SwapState(mjData& d) {
  std::swap_ranges(q_.begin(), q_.end(), d.qpos);
  std::swap_ranges(v_.begin(), v_.end(), d.qvel);
  std::swap_ranges(w_.begin(), w_.end(), d.act);
}

bool StepSensitivity::After(const mjModel& m, mjData& d) {
  if (!FindRows(d)) return false;
  after_.assign(d.qvel, d.qvel + m.nv), a_.resize(m.nv);
  for (int i = 0; i < m.nv; ++i) a_[i] = (after_[i] - v_[i]) / m.opt.timestep;
  SwapState(d);  // it holds the step's forces already
  const bool followed = Follow(m, d);
  SwapState(d);
  return followed;
}

void StepSensitivity::Observe(const mjModel& m, mjData& d, std::size_t row,
                              std::span<Recorder> recorders) {
  sensors_.Update(m, d);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    const Eigen::VectorXd dq = move_ * dq_.col(column), dv = move_ * dv_.col(column);
    sensors_.Move(d, dq.data(), dv.data());
    recorders[columns_[c]].Take(d, row);
    sensors_.Back(d);
  }
}

}  // namespace continuum
