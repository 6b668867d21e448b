#include "identification/diagnosis/equation_error.h"

#include <cmath>

#include <Eigen/Dense>

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

}  // namespace

EquationErrors::EquationErrors(const Experiment& experiment, const ModelSpec& system,
                               const Fitted& base)
    : experiment_(experiment), x_(base.fit.x) {
  const Problem problem(experiment, system);
  const auto joints = MissingForces(problem, x_, problem.TrainLogs());
  if (joints.empty()) return;
  units_ = StackedForces(joints, &MissingForce::force);
  for (const MissingForce& joint : joints)
    log_.insert(log_.end(), joint.log.begin(), joint.log.end());
  missing_ = units_.Of(joints);
  const auto count = static_cast<Eigen::Index>(problem.parameters().size());
  Problem::Matrix columns = Problem::Matrix::Zero(missing_.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    if (problem.parameters()[k].IsStart()) continue;
    Vector moved = x_;
    moved[k] += problem.StepOf(x_, k, 1e-3);
    const Vector column = Stacked(problem, moved) - missing_;
    if (column.norm() > 1e-12) columns.col(k) = column;
  }
  basis_ = Basis(columns);
  force_ = missing_ - basis_ * (basis_.transpose() * missing_);
}

Vector EquationErrors::Stacked(const Problem& problem, const Vector& x) const {
  return units_.Of(MissingForces(problem, x, problem.TrainLogs()));
}

std::optional<ByEquation> EquationErrors::Of(const CandidateResult& c) const {
  constexpr double kNothing = 1e-6;  // of the missing force
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
