#include "sim/simulation/rest_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "binding/effect_catalog.h"
#include "sim/numerics/decompositions.h"
#include "sim/simulation/force_probe.h"
#include "sim/simulation/initial_state.h"

namespace continuum {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kNear = 1e-10;  // rad or m; a step that ends the search

// Laws of a state of their own are followed on their way, but for constant dry friction: what that
// remembers at rest is the position.
std::string ObstacleOf(const mjModel& m) {
  for (int i = 0; i < m.nplugin; ++i) {
    const EffectInfo* const effect = EffectOf(m, i);
    if (!effect) return "a plugin of others";
    if (m.plugin_statenum[i] > 0 && !effect->IsConstantFriction())
      return "a law that remembers: " + std::string(effect->name);
  }
  for (int j = 0; j < m.njnt; ++j) {
    const bool turns = m.jnt_type[j] == mjJNT_BALL || m.jnt_type[j] == mjJNT_FREE;
    if (turns && m.dof_frictionloss[m.jnt_dofadr[j]] > 0) return "dry friction of a ball joint";
  }
  return "";
}

// Whether nothing but dry friction of joints constrains the motion.
bool OnlyRubs(const mjData& d) {
  return std::all_of(d.efc_type, d.efc_type + d.nefc,
                     [](int type) { return type == mjCNSTR_FRICTION_DOF; });
}

VectorXd LevelsOf(const mjModel& m, const mjData& d) {
  VectorXd level = VectorXd::Zero(m.nv);
  for (int r = 0; r < d.nefc; ++r) {
    if (d.efc_type[r] == mjCNSTR_FRICTION_DOF) level[d.efc_id[r]] = d.efc_frictionloss[r];
  }
  return level;
}

// The rows of friction take a new position for one that they have always had.
void ForgetAnchors(const mjModel& m, mjData& d) {
  for (int i = 0; i < m.nplugin; ++i)
    std::fill_n(d.plugin_state + m.plugin_stateadr[i], m.plugin_statenum[i], 0.0);
}

MatrixXd StiffnessAt(ForceProbe& at, const VectorXd& x, const VectorXd& f) {
  constexpr double kMove = 1e-7;  // rad or m
  MatrixXd K(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    K.col(i) = (f - at.Moved(x + kMove * VectorXd::Unit(x.size(), i))) / kMove;
  return K;
}

bool Holds(const MatrixXd& K) {
  const Eigen::LDLT<MatrixXd> factors(MatrixXd(0.5 * (K + K.transpose())));
  return K.allFinite() && factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0;
}

}  // namespace

RestSearch::RestSearch(mjModel& m, mjData& d, const Hooks& hooks)
    : m_(m), d_(d), hooks_(hooks), obstacle_(ObstacleOf(m)) {
  mj_forward(&m, &d);
  level_ = LevelsOf(m, d);
}

bool RestSearch::Advance() {
  VectorXd x = VectorXd::Zero(m_.nv);
  if (!FindDisplacement(x)) return false;
  const std::vector<double> before = StateOf(m_, d_, mjSTATE_INTEGRATION);
  mj_integratePos(&m_, d_.qpos, x.data(), 1);
  mju_zero(d_.qvel, static_cast<int>(m_.nv));
  ForgetAnchors(m_, d_);
  mj_fwdPosition(&m_, &d_);
  if (OnlyRubs(d_)) return true;
  mj_setState(&m_, &d_, before.data(), mjSTATE_INTEGRATION);
  return false;
}

bool RestSearch::FindDisplacement(VectorXd& x) {
  constexpr int kSteps = 40;
  constexpr double kFar = 0.5;  // rad or m; a step beyond the reach of Newton's method
  ForceProbe at(m_, d_, &hooks_);
  VectorXd f = at.Moved(x);
  double before = kFar;
  for (int k = 0; k < kSteps && f.allFinite(); ++k) {
    const bool measured = stiffness_.size() == 0;
    if (measured) stiffness_ = StiffnessAt(at, x, f);
    VectorXd step = StepAt(x, f);
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!measured && (length > kNear ? !(length < before) : !Holds(stiffness_))) {
      stiffness_ = StiffnessAt(at, x, f);
      step = StepAt(x, f);
    }
    before = step.lpNorm<Eigen::Infinity>();
    if (!(before < kFar)) break;
    if (before <= kNear) {
      x += step;
      if (Holds(stiffness_)) return true;
      break;
    }
    const VectorXd from = x, force = f;
    f = GoAlong(at, step, x, f);
    Learn(x - from, force - f);
  }
  stiffness_.resize(0, 0);
  return false;
}

// Broyden's update, once for a step.
void RestSearch::Learn(const VectorXd& moved, const VectorXd& resisted) {
  stiffness_ += (resisted - stiffness_ * moved) * (moved.transpose() / moved.squaredNorm());
}

VectorXd RestSearch::StepAt(const VectorXd& x, const VectorXd& f) const {
  constexpr int kRounds = 30;
  VectorXd step = VectorXd::Zero(x.size()), slides, before;
  for (int round = 0; round < kRounds; ++round) {
    slides = SlidingAt(x + step, f - stiffness_ * step);
    if (round > 0 && slides == before) break;
    before = slides;
    MatrixXd A = stiffness_;
    VectorXd b = f - slides.cwiseProduct(level_);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (slides[i] != 0) continue;
      A.row(i) = VectorXd::Unit(x.size(), i).transpose();
      b[i] = -x[i];
    }
    step = A.partialPivLu().solve(b);
  }
  return step;
}

VectorXd RestSearch::SlidingAt(const VectorXd& x, const VectorXd& f) const {
  VectorXd slides(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double reach = x[i] + f[i] / stiffness_(i, i), held = level_[i] / stiffness_(i, i);
    slides[i] = level_[i] == 0 || reach > held ? 1 : reach < -held ? -1 : 0;
  }
  return slides;
}

VectorXd RestSearch::GoAlong(ForceProbe& at, const VectorXd& step, VectorXd& x,
                             const VectorXd& f) const {
  constexpr int kMost = 8;
  constexpr double kFlatter = 0.5;
  // Of energy and friction work along the step, at a share of it, seen from one side (1: from
  // there on, −1: till there) where what slides stands at 0.
  const auto slope = [&](double share, const VectorXd& force, int side) {
    double rub = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double there = x[i] + share * step[i];
      rub += level_[i] * (std::abs(there) < kNear ? side * std::abs(step[i])
                                                  : std::copysign(1, there) * step[i]);
    }
    return rub - force.dot(step);
  };
  const double first = slope(0, f, 1);
  double share = 1;
  VectorXd force = at.Moved(x + step);
  for (int k = 0; k < kMost && first < 0; ++k) {
    const double here = slope(share, force, -1);
    if (here <= -kFlatter * first) break;
    share *= std::clamp(first / (first - here), 0.1, 0.9);
    force = at.Moved(x + share * step);
  }
  x += share * step;
  return force;
}

}  // namespace continuum
