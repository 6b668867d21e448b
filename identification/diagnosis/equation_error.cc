#include "identification/diagnosis/equation_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "binding/effect_catalog.h"
#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/probing.h"
#include "identification/diagnosis/search_rules.h"
#include "identification/fit/bounded_least_squares.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kNothing = 1e-6;  // of the missing force

}  // namespace

EquationErrors::EquationErrors(const Problem& base, const Vector& x, std::vector<bool> use)
    : experiment_(base.experiment()), x_(x), use_(std::move(use)) {
  const auto joints = MissingForces(base, x_, use_);
  if (joints.empty()) return;
  units_ = StackedForces(joints, &MissingForce::force);
  for (const MissingForce& joint : joints)
    log_.insert(log_.end(), joint.log.begin(), joint.log.end());
  missing_ = units_.Of(joints);
  columns_ = Matrix::Zero(missing_.size(), x_.size());
  ParallelFor(static_cast<std::size_t>(x_.size()), [&](std::size_t thread, std::size_t i) {
    if (base.parameters()[i].IsStart()) return;
    const auto k = static_cast<Eigen::Index>(i);
    const double step = base.StepOf(x_, i, 1e-3);
    Vector moved = x_;
    moved[k] += step;
    const Vector column = (Stacked(base, moved, thread) - missing_) / step;
    if (column.allFinite() && column.norm() * std::abs(step) > 1e-12) columns_.col(k) = column;
  });
  StayWithinBounds(base);
  basis_ = Basis(columns_);
  force_ -= basis_ * (basis_.transpose() * force_);
}

// Parameters that the missing force draws to a bound stay there: the candidate has to explain what
// they would beyond it.
void EquationErrors::StayWithinBounds(const Problem& base) {
  const Box box = BoundsOf(base);
  held_ = SolveWithinBox(box, x_, columns_, missing_);
  force_ = missing_ + columns_ * (held_ - x_);
  for (Eigen::Index k = 0; k < x_.size(); ++k) {
    if (held_[k] <= box.lower[k] || held_[k] >= box.upper[k]) columns_.col(k).setZero();
  }
}

Vector EquationErrors::Stacked(const Problem& problem, const Vector& x, std::size_t thread) const {
  return units_.Of(MissingForces(problem, x, use_, thread));
}

std::optional<EquationStart> EquationErrors::StartOf(const Hypothesis& h,
                                                     const Problem& problem) const {
  constexpr double kAnything = 0.01;  // of the missing force
  std::optional<EquationStart> best = From(h, problem, 0);
  if (!best || best->share < kAnything) return best;
  for (const std::size_t other : h.StartsOfShape(false)) {
    auto next = From(h, problem, other);
    if (next && (!best || next->share > best->share)) best = std::move(next);
  }
  return best;
}

// A friction at its start may hold what moves, which is no measure of it: it is tried small as
// well.
std::optional<EquationStart> EquationErrors::From(const Hypothesis& h, const Problem& problem,
                                                  std::size_t which) const {
  constexpr double kSmall = 0.1;
  if (!any() || h.OnlyMeasured()) return {};
  auto whole = AtShare(h, problem, which, 1);
  if (EffectNamed(h.Card()).kind != EffectInfo::Kind::kFriction) return whole;
  auto small = AtShare(h, problem, which, kSmall);
  return small && (!whole || small->share > whole->share) ? small : whole;
}

// Each amplitude by itself, the others absent; sizes by least squares, of allowed signs.
std::optional<EquationStart> EquationErrors::AtShare(const Hypothesis& h, const Problem& problem,
                                                     std::size_t which, double share) const {
  const std::vector<double>& start = h.starts[which];
  const auto amplitudes = h.Amplitudes();
  const auto count = static_cast<Eigen::Index>(amplitudes.size());
  Matrix D = Matrix::Zero(missing_.size(), count);
  Probe probe;
  for (Eigen::Index a = 0; a < count; ++a) {
    const std::size_t only = amplitudes[static_cast<std::size_t>(a)];
    std::vector<double> own = start;
    for (const std::size_t i : amplitudes) own[i] = h.AtShare(i, start[i], i == only ? share : 0);
    const Vector d = (Stacked(problem, Append(x_, own)) - missing_) / share;
    if (d.allFinite() && d.norm() > kNothing * missing_.norm()) D.col(a) = d;
    probe.sign.push_back(h.OneSign(only) ? 1 : 0);
  }
  if (!(D.norm() > 0)) return {};
  probe.columns = D - basis_ * (basis_.transpose() * D);
  const Explained e = PlainlyExplainedBy(probe, force_);
  std::vector<double> own = start;
  for (Eigen::Index a = 0; a < count; ++a) {
    const std::size_t i = amplitudes[static_cast<std::size_t>(a)];
    own[i] = h.AtShare(i, start[i], StartShare(e.coefficients[a], share));
    own[i] = std::clamp(own[i], h.extra[i].lower, h.extra[i].upper);
  }
  Vector beside = held_;
  if (x_.size() > 0)
    beside -= columns_.completeOrthogonalDecomposition().solve(force_ + D * e.coefficients);
  return EquationStart{which, e.amount / force_.squaredNorm(), problem.Clamp(Append(x_, own)),
                       problem.Clamp(Append(beside, own))};
}

std::optional<ByEquation> EquationErrors::Of(const CandidateResult& c) const {
  if (!any() || !c.was_fitted || !c.hypothesis.given.empty()) return {};
  Vector x = c.fitted.fit.x;
  x.head(x_.size()) = x_;
  Vector d = missing_ - Stacked(ProblemOf(c, experiment_), x);
  if (!d.allFinite() || d.norm() < kNothing * missing_.norm()) return {};
  d -= basis_ * (basis_.transpose() * d);
  const double amplitude = std::max(0.0, d.dot(force_) / std::max(d.squaredNorm(), 1e-300));
  const Vector residual = force_ - amplitude * d;
  ByEquation result;
  result.share = 1 - residual.squaredNorm() / force_.squaredNorm();
  result.before = PerLog(force_), result.after = PerLog(residual);
  return result;
}

std::vector<double> EquationErrors::PerLog(const Vector& r) const {
  std::vector<double> squares(experiment_.logs.size(), 0);
  for (std::size_t i = 0; i < log_.size(); ++i)
    squares[log_[i]] += std::pow(r[static_cast<Eigen::Index>(i)], 2);
  std::vector<double> roots;
  for (const double sum : squares) {
    if (sum > 0) roots.push_back(std::sqrt(sum));
  }
  return roots;
}

bool ClearlyBetterByEquation(const CandidateResult& a, const CandidateResult& b,
                             const Criteria& criteria) {
  if (!a.by_equation || !b.by_equation) return false;
  FoldRecord first, second;
  first.before = second.before = a.by_equation->before;
  first.after = a.by_equation->after, second.after = b.by_equation->after;
  return ClearlyBetter(first, second, criteria.fold_margin, criteria);
}

}  // namespace continuum
