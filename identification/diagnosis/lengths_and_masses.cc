#include "identification/diagnosis/lengths_and_masses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/object_sets.h"
#include "identification/diagnosis/probing.h"
#include "identification/statistics/information_modes.h"
#include "identification/statistics/uncertainty.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// Whether an effect multiplies one number of each body, its length or its mass.
bool ScalesBodies(const EffectInfo& effect) {
  return effect.kind == EffectInfo::Kind::kEdit && effect.places.front() == Place::kBody &&
         effect.params.size() == 1 && effect.params.front().null == 1;
}

// What a number that is off by a share of itself does to the residuals; nothing where the
// simulation diverges.
std::vector<Vector> ColumnOf(const Problem& problem, const Fitted& fitted, double share) {
  const std::vector<bool> train = problem.TrainLogs();
  std::vector<Vector> column;
  try {
    column = problem.Residuals(Append(fitted.fit.x, {1 + share}), train);
  } catch (const Error&) {
    return {};
  }
  for (std::size_t l = 0; l < column.size(); ++l)
    if (train[l]) column[l] -= fitted.residuals[l];
  return column;
}

// (1) by its normal equations.
ByLengthsAndMasses WithPriors(const Matrix& C, const Vector& z, double known) {
  const Matrix normal = C.transpose() * C + Matrix::Identity(C.cols(), C.cols());
  const Vector b = C.transpose() * z;
  const Vector a = normal.ldlt().solve(b);
  return {b.dot(a), known * a.cwiseAbs().maxCoeff(), a.size()};
}

// [number][log] what each number that is off by link_known does to the residuals of a fit; nothing
// where there is no time for it.
std::vector<std::vector<Vector>> ColumnsOf(const CandidateFitter& fitter, const Sizes& sizes,
                                           const ModelSpec& system,
                                           const std::vector<Parameter>& given,
                                           const Fitted& fitted) {
  const Experiment& e = *fitter.experiment;
  const SearchBase base{&system, given, Problem(e, system, given).CommonChanges(fitted.fit.x)};
  std::vector<std::vector<Vector>> columns;
  for (const Hypothesis& h : NumbersOfBodies({e, base, sizes})) {
    if (fitter.TimeIsOver()) return {};
    auto column = ColumnOf(Problem(e, h.system, h.Free()), fitted, fitter.criteria.link_known);
    if (!column.empty()) columns.push_back(std::move(column));
  }
  return columns;
}

// J, without what a bound holds, and C beside it, whitened.
Matrix Beside(const CandidateFitter& fitter, const Fitted& fitted,
              const std::vector<std::vector<Vector>>& columns) {
  const std::vector<bool> train = TrainLogs(*fitter.experiment);
  const Sensitivities& s = fitted.sensitivities.value();
  const Matrix J = fitter.whitening.Stack(s.jacobian, train);
  const Eigen::Index n = J.cols();
  Matrix all(J.rows(), n + static_cast<Eigen::Index>(columns.size()));
  all.leftCols(n) = J;
  for (Eigen::Index i = 0; i < n; ++i)
    if (s.uncertainty.at_bound[static_cast<std::size_t>(i)]) all.col(i).setZero();
  for (std::size_t k = 0; k < columns.size(); ++k)
    all.col(n + static_cast<Eigen::Index>(k)) = fitter.whitening.Stack(columns[k], train);
  return all;
}

// [parameter] standard errors over those that white noise would make, at least 1: what lasts in the
// residual, and what of it is no noise.
Vector Lasting(const Uncertainty& u, const Matrix& normal) {
  const Eigen::Index n = u.standard_error.size();
  const Matrix white = InformationModes(normal.topLeftCorner(n, n)).Inverse();
  Vector times = Vector::Ones(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (white(i, i) > 0) times[i] = std::max(1.0, u.standard_error[i] / std::sqrt(white(i, i)));
  }
  return times;
}

// The residual at a step of zero, whitened.
Vector AtStepOfZero(const CandidateFitter& fitter, const Fitted& fitted) {
  const std::vector<bool> train = TrainLogs(*fitter.experiment);
  std::vector<Vector> fine = fitted.residuals;
  for (std::size_t l = 0; l < train.size(); ++l)
    if (train[l]) fine[l] -= kWholeStep * fitted.sensitivities->step[l].col(0);
  return fitter.whitening.Stack(fine, train);
}

// (2); A: J and C beside each other.
Vector MovedBy(const Matrix& A, Eigen::Index parameters) {
  const Matrix J = A.leftCols(parameters), C = A.rightCols(A.cols() - parameters);
  const Matrix moved = InformationModes(J.transpose() * J).Inverse() * (J.transpose() * C);
  return moved.rowwise().norm();
}

// (3); z: the whitened residual.
void ReachOver(const Problem& problem, const Matrix& A, const Vector& z, const Vector& x,
               Uncertainty& u) {
  constexpr double kT = 1.96;
  const Eigen::Index n = x.size();
  Matrix normal = A.transpose() * A;
  normal.diagonal().tail(A.cols() - n).array() += 1;
  const Matrix inverse = InformationModes(normal).Inverse();
  const Vector change = -inverse * (A.transpose() * z);
  const Vector spread = inverse.diagonal().head(n).cwiseMax(0).cwiseSqrt(),
               half = kT * Lasting(u, normal).cwiseProduct(spread), there = x + change.head(n);
  Widen(problem, (there - half - u.lower).cwiseMin(0), (there + half - u.upper).cwiseMax(0), u);
}

}  // namespace

std::vector<Hypothesis> NumbersOfBodies(const CandidateContext& context) {
  std::vector<Hypothesis> all;
  const mjModel& m = context.from.system->model();
  for (const EffectInfo& effect : Catalog()) {
    if (!ScalesBodies(effect)) continue;
    const auto bodies = PlacesFor(m, effect, Place::kBody, "*", context.experiment);
    for (const std::string& body : bodies) {
      const Candidate wanted{std::string(effect.name), "", false};
      try {
        all.push_back(HypothesisAt(effect, wanted, {Place::kBody, {body}}, 0, context));
      } catch (const Error&) {
        continue;  // it has none, or the experiment fits it
      }
    }
  }
  return all;
}

ByLengthsAndMasses ExplainedByLengthsAndMasses(const CandidateFitter& fitter, const Sizes& sizes,
                                               const ModelSpec& system,
                                               const std::vector<Parameter>& given,
                                               const Fitted& fitted) {
  if (!fitted.complete()) return {};
  const ProjectedResidual residual = fitter.ProjectedResidualOf(fitted);
  const Vector z = residual.vector();
  Matrix C(z.size(), 0);
  for (const auto& column : ColumnsOf(fitter, sizes, system, given, fitted)) {
    C.conservativeResize(Eigen::NoChange, C.cols() + 1);
    C.rightCols(1) = residual.Project({column.begin(), column.end()});
  }
  return C.cols() > 0 ? WithPriors(C, z, fitter.criteria.link_known) : ByLengthsAndMasses{};
}

void AllowForLengthsAndMasses(const CandidateFitter& fitter, const Sizes& sizes,
                              const ModelSpec& system, const std::vector<Parameter>& given,
                              bool more_is_left, Fitted& fitted) {
  if (!fitted.complete()) return;
  const auto columns = ColumnsOf(fitter, sizes, system, given, fitted);
  if (columns.empty()) return;
  const Matrix A = Beside(fitter, fitted, columns);
  Uncertainty& u = fitted.sensitivities->uncertainty;
  u.by_numbers = MovedBy(A, fitted.fit.x.size());
  if (more_is_left)
    ReachOver(Problem(*fitter.experiment, system, given), A, AtStepOfZero(fitter, fitted),
              fitted.fit.x, u);
}

}  // namespace continuum
