#include "identification/diagnosis/lengths_and_masses.h"

#include <utility>

#include <Eigen/Cholesky>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/object_sets.h"
#include "identification/diagnosis/probing.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// Whether an effect multiplies one number of each body, its length or its mass.
bool ScalesBodies(const EffectInfo& effect) {
  return effect.kind == EffectInfo::Kind::kEdit && effect.places.front() == Place::kBody &&
         effect.params.size() == 1 && effect.params.front().null == 1;
}

// Each body that has a length or a mass, by itself; none of those that the experiment fits.
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

}  // namespace

ByLengthsAndMasses ExplainedByLengthsAndMasses(const CandidateFitter& fitter, const Sizes& sizes,
                                               const ModelSpec& system,
                                               const std::vector<Parameter>& given,
                                               const Fitted& fitted) {
  if (!fitted.complete()) return {};
  const Experiment& e = *fitter.experiment;
  const SearchBase base{&system, given, Problem(e, system, given).CommonChanges(fitted.fit.x)};
  const ProjectedResidual residual = fitter.ProjectedResidualOf(fitted);
  const Vector z = residual.vector();
  const double known = fitter.criteria.link_known;
  Matrix C(z.size(), 0);
  for (const Hypothesis& h : NumbersOfBodies({e, base, sizes})) {
    if (fitter.TimeIsOver()) return {};
    const auto column = ColumnOf(Problem(e, h.system, h.Free()), fitted, known);
    if (column.empty()) continue;
    const std::vector<Matrix> columns(column.begin(), column.end());
    C.conservativeResize(Eigen::NoChange, C.cols() + 1);
    C.rightCols(1) = residual.Project(columns);
  }
  return C.cols() > 0 ? WithPriors(C, z, known) : ByLengthsAndMasses{};
}

}  // namespace continuum
