#include "sim/model/joint_equalities.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

constexpr double kRounding = 1e-12;  // of offsets and ratios that cancel
constexpr double kWritten = 1e-5;    // of ratios that close a circle, as they are written

int PositionCount(int type) { return type == mjJNT_FREE ? 7 : type == mjJNT_BALL ? 4 : 1; }
int DofCount(int type) { return type == mjJNT_FREE ? 6 : type == mjJNT_BALL ? 3 : 1; }

}  // namespace

JointEqualities::JointEqualities(const mjModel& m) : column_(m.nv, kHeld), entry_(m.nv, 1) {
  for (int j = 0; j < m.njnt; ++j) tie_.push_back({j, 0, 1});
  const bool off = m.opt.disableflags & (mjDSBL_EQUALITY | mjDSBL_CONSTRAINT);
  for (int i = 0; i < m.neq && !off; ++i) {
    if (m.eq_active0[i] && obstacle_.empty()) Join(m, i);
  }
  std::vector<int> column(m.njnt, kHeld);
  for (int j = 0; j < m.njnt; ++j) {
    if (tie_[j].on != j) continue;
    column[j] = static_cast<int>(dofs_.size());
    for (int i = 0; i < PositionCount(m.jnt_type[j]); ++i)
      positions_.push_back(m.jnt_qposadr[j] + i);
    for (int i = 0; i < DofCount(m.jnt_type[j]); ++i) dofs_.push_back(m.jnt_dofadr[j] + i);
  }
  for (int v = 0; v < m.nv; ++v) {
    const int j = m.dof_jntid[v];
    const Tie& tie = tie_[j];
    if (tie.on == kHeld) continue;
    column_[v] = column[tie.on] + v - m.jnt_dofadr[j];
    entry_[v] = tie.ratio;
  }
  if (obstacle_.empty() && dofs_.empty() && m.nv > 0) obstacle_ = "equalities hold every joint";
  if (none()) return;
  inertia_.resize(column_.size() * column_.size());
  reduced_.resize(dofs_.size() * dofs_.size());
  force_.resize(dofs_.size());
  rate_.resize(dofs_.size());
}

// An equality says x₁ = p₀ + p₁ x₂ of x = q − q₀. With what is known of both joints it either ties
// the free joint of one to that of the other, or holds one, or says nothing new.
void JointEqualities::Join(const mjModel& m, int equality) {
  const double* const p = m.eq_data + mjNEQDATA * equality;
  if (m.eq_type[equality] != mjEQ_JOINT) {
    obstacle_ = Called(m, equality) + " ties no joints";
    return;
  }
  const int second = m.eq_obj2id[equality];
  if (second >= 0 && (p[2] != 0 || p[3] != 0 || p[4] != 0)) {
    obstacle_ = Called(m, equality) + " is not linear";
    return;
  }
  const Tie one = tie_[m.eq_obj1id[equality]];
  const Tie two = second >= 0 ? tie_[second] : Tie{kHeld, 0, 0};
  double slope = second >= 0 ? p[1] * two.ratio : 0;
  const double constant = p[0] + (second >= 0 ? p[1] * two.offset : 0) - one.offset;
  if (two.on == kHeld) slope = 0;
  double own = one.on == kHeld ? 0 : one.ratio;
  if (one.on == two.on) {
    const bool closed = std::abs(own - slope) <= kWritten * std::abs(own);
    own = closed ? 0 : own - slope, slope = 0;
  }
  if (std::abs(own) > kRounding) {
    Replace(one.on, {slope == 0 ? kHeld : two.on, constant / own, slope / own});
  } else if (std::abs(slope) > kRounding) {
    Replace(two.on, {kHeld, -constant / slope, 0});
  } else if (std::abs(constant) > kRounding) {
    obstacle_ = Called(m, equality) + " contradicts others";
  }
}

void JointEqualities::Replace(int joint, const Tie& by) {
  for (Tie& tie : tie_) {
    if (tie.on != joint) continue;
    tie.offset += tie.ratio * by.offset;
    tie.ratio *= by.ratio;
    tie.on = by.on;
  }
}

std::string JointEqualities::Called(const mjModel& m, int equality) const {
  return "equality " + continuum::Called(m, mjOBJ_EQUALITY, equality);
}

void JointEqualities::FreePositions(const double* all, double* free) const {
  for (const int q : positions_) *free++ = all[q];
}

void JointEqualities::FreeVelocities(const double* all, double* free) const {
  for (const int v : dofs_) *free++ = all[v];
}

void JointEqualities::Spread(const mjModel& m, const double* position, const double* velocity,
                             mjData& d) const {
  for (std::size_t i = 0; i < positions_.size(); ++i) d.qpos[positions_[i]] = position[i];
  for (int v = 0; v < m.nv; ++v)
    d.qvel[v] = column_[v] == kHeld ? 0 : entry_[v] * velocity[column_[v]];
  for (int j = 0; j < m.njnt; ++j) {
    const Tie& tie = tie_[j];
    if (tie.on == j) continue;
    const int q = m.jnt_qposadr[j];
    d.qpos[q] = m.qpos0[q] + tie.offset;
    if (tie.on == kHeld) continue;
    const int on = m.jnt_qposadr[tie.on];
    d.qpos[q] += tie.ratio * (d.qpos[on] - m.qpos0[on]);
  }
}

void JointEqualities::Project(const double* force, double* free) const {
  std::fill_n(free, dofs_.size(), 0.0);
  for (std::size_t v = 0; v < column_.size(); ++v) {
    if (column_[v] != kHeld) free[column_[v]] += entry_[v] * force[v];
  }
}

void JointEqualities::Accelerate(const mjModel& m, mjData& d) {
  const int free = static_cast<int>(dofs_.size());
  mj_fullM(&m, &d, inertia_.data());
  std::fill(reduced_.begin(), reduced_.end(), 0.0);
  Project(d.qfrc_smooth, force_.data());
  for (int i = 0; i < m.nv; ++i) {
    if (column_[i] == kHeld) continue;
    for (int j = 0; j < m.nv; ++j) {
      if (column_[j] == kHeld) continue;
      reduced_[column_[i] * free + column_[j]] += entry_[i] * entry_[j] * inertia_[i * m.nv + j];
    }
  }
  mju_cholFactor(reduced_.data(), free, mjMINVAL);
  mju_cholSolve(rate_.data(), reduced_.data(), force_.data(), free);
  for (int v = 0; v < m.nv; ++v)
    d.qacc[v] = column_[v] == kHeld ? 0 : entry_[v] * rate_[column_[v]];
}

}  // namespace continuum
