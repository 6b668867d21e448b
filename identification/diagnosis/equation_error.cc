#include "identification/diagnosis/equation_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include "binding/effect_catalog.h"
#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/plainest.h"
#include "identification/diagnosis/probing.h"
#include "identification/diagnosis/search_rules.h"
#include "identification/fit/bounded_least_squares.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kNothing = 1e-6;  // of the missing force
// Steps of the model: what a law changes in a force is seen in a few steps from the measured state
// as well as in many. Not what a law remembers, which it learns on the way.
constexpr double kCoarse = 5;

bool Remembers(const mjModel& m) {
  for (int i = 0; i < m.nplugin; ++i) {
    const EffectInfo* const effect = EffectOf(m, i);
    if (effect && effect->remembers) return true;
  }
  return false;
}

}  // namespace

EquationErrors::EquationErrors(const Problem& base, const Vector& x, std::vector<bool> use)
    : experiment_(base.experiment()), x_(x), use_(std::move(use)) {
  joints_ = MissingForces(base, x_, use_);
  if (joints_.empty()) return;
  units_ = StackedForces(joints_, &MissingForce::force);
  for (const MissingForce& joint : joints_)
    log_.insert(log_.end(), joint.log.begin(), joint.log.end());
  missing_ = units_.Of(joints_);
  coarse_step_ = kCoarse * base.step();
  coarse_ = Stacked(base, x_, coarse_step_);
  columns_ = Matrix::Zero(missing_.size(), x_.size());
  const auto differ = [&](std::size_t, std::size_t i) {
    if (base.parameters()[i].IsStart()) return;
    const auto k = static_cast<Eigen::Index>(i);
    const double step = base.StepOf(x_, i, 1e-3);
    Vector moved = x_;
    moved[k] += step;
    const Vector column = Change(base, moved) / step;
    if (column.allFinite() && column.norm() * std::abs(step) > 1e-12) columns_.col(k) = column;
  };
  ShareOut(static_cast<std::size_t>(x_.size()), differ, [&](auto& archive, std::size_t i) {
    FieldsOfBlock(archive, columns_.col(static_cast<Eigen::Index>(i)));
  });
  bounds_ = BoundsOf(base);
  force_ = Beside(Matrix(missing_.size(), 0), {}).left;
}

// Least squares within the bounds of the parameters, which may leave them beside a candidate, and
// with sizes of allowed signs.
EquationErrors::Solved EquationErrors::Beside(const Matrix& D, const std::vector<int>& sign) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Matrix J(missing_.size(), x_.size() + D.cols());
  J.leftCols(x_.size()) = columns_, J.rightCols(D.cols()) = D;
  Box box{Append(bounds_.lower, std::vector<double>(sign.size(), -kInfinity)),
          Append(bounds_.upper, std::vector<double>(sign.size(), kInfinity))};
  for (std::size_t i = 0; i < sign.size(); ++i) {
    if (sign[i] > 0) box.lower[x_.size() + static_cast<Eigen::Index>(i)] = 0;
  }
  const Vector begin = Append(x_, std::vector<double>(sign.size(), 0));
  const Vector y = SolveWithinBox(box, begin, J, missing_);
  return {y.head(x_.size()), y.tail(D.cols()), missing_ + J * (y - begin)};
}

Vector EquationErrors::Stacked(const Problem& problem, const Vector& x, double step) const {
  return units_.Of(MissingForces(problem, x, use_, step));
}

Vector EquationErrors::Change(const Problem& problem, const Vector& to) const {
  return NeedsOwnStep(problem) || Remembers(problem.system().model())
             ? Vector(Stacked(problem, to) - missing_)
             : Vector(Stacked(problem, to, coarse_step_) - coarse_);
}

EquationStart EquationErrors::BestShape(const Hypothesis& h, const Problem& problem,
                                        EquationStart best) const {
  constexpr double kAnything = 0.01;  // of the missing force
  if (best.share < kAnything) return best;
  for (const std::size_t other : h.StartsOfShape(false)) {
    auto next = From(h, problem, other);
    if (next && next->share > best.share) best = *std::move(next);
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
  std::vector<int> sign;
  for (Eigen::Index a = 0; a < count; ++a) {
    const std::size_t only = amplitudes[static_cast<std::size_t>(a)];
    std::vector<double> own = start;
    for (const std::size_t i : amplitudes) own[i] = h.AtShare(i, start[i], i == only ? share : 0);
    const Vector d = Change(problem, Append(x_, own)) / share;
    if (d.allFinite() && d.norm() > kNothing * missing_.norm()) D.col(a) = d;
    sign.push_back(h.OneSign(only) ? 1 : 0);
  }
  if (!(D.norm() > 0)) return {};
  const Solved solved = PlainestOf(
      D, [&](const Matrix& some) { return Beside(some, sign); },
      [&](const Solved& some) { return Amount(some); });
  std::vector<double> own = start;
  for (Eigen::Index a = 0; a < count; ++a) {
    const std::size_t i = amplitudes[static_cast<std::size_t>(a)];
    own[i] = h.AtShare(i, start[i], StartShare(solved.sizes[a], share));
    own[i] = std::clamp(own[i], h.extra[i].lower, h.extra[i].upper);
  }
  return EquationStart{which, Amount(solved) / force_.squaredNorm(), problem.Clamp(Append(x_, own)),
                       problem.Clamp(Append(solved.x, own))};
}

std::optional<ByEquation> EquationErrors::Of(const CandidateResult& c) const {
  if (!any() || !c.was_fitted || !c.hypothesis.given.empty()) return {};
  Vector x = c.fitted.fit.x;
  x.head(x_.size()) = x_;
  const Vector d = Stacked(ProblemOf(c, experiment_), x) - missing_;
  if (!d.allFinite() || d.norm() < kNothing * missing_.norm()) return {};
  const Solved solved = Beside(d, {1});
  ByEquation result;
  result.share = Amount(solved) / force_.squaredNorm();
  result.before = PerLog(force_), result.after = PerLog(solved.left);
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
