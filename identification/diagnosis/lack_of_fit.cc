#include "identification/diagnosis/lack_of_fit.h"

#include <boost/math/distributions/chi_squared.hpp>

#include "identification/candidates/random_forces.h"
#include "identification/diagnosis/probing.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// p-value of what unsigned columns explain of white noise of size 1.
double ChiSquared(const Matrix& columns, const Vector& z, double inflation) {
  Probe probe{columns, std::vector<double>(columns.cols(), 0)};
  const double rank = static_cast<double>(
      std::min<Eigen::Index>(columns.cols(), (columns.colwise().norm().array() > 1e-9).count()));
  if (rank < 1) return 1;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(rank),
                                                  ExplainedBy(probe, z).amount / inflation));
}

// Of each counted channel: a constant, and a shift in time.
Matrix ChannelColumns(const Problem& problem, const Trace& trace, const Log& log) {
  const auto rows = static_cast<Eigen::Index>(log.rows());
  const auto channels = static_cast<Eigen::Index>(problem.channels().size());
  Matrix columns = Matrix::Zero(rows * channels, 2 * channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    const auto& y = trace.channel[problem.channels()[c]];
    for (Eigen::Index k = 0; k < rows; ++k) {
      columns(c * rows + k, 2 * c) = 1;
      if (k == 0 || k + 1 == rows) continue;
      columns(c * rows + k, 2 * c + 1) =
          (y[k + 1] - y[k - 1]) / (log.time[k + 1] - log.time[k - 1]) / problem.scale(c);
    }
  }
  return columns;
}

// What the forces of free form do, in coarse steps where it can be; r: the residuals in its own.
std::vector<Matrix> ForceColumns(Problem problem, const Vector& x, const std::vector<Vector>& r,
                                 const std::vector<Matrix>& known, Eigen::Index count) {
  const std::vector<bool> train = problem.TrainLogs();
  const auto coarse = StepCoarsely(problem, x, r);
  auto J = problem.Jacobian(x, coarse ? *coarse : r, train, known);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (train[l]) J[l] = Matrix(J[l].rightCols(count));
  }
  return J;
}

}  // namespace

LackOfFit TestLackOfFit(const CandidateFitter& fitter, const Problem& without,
                        const std::vector<Parameter>& extra, const Fitted& fitted,
                        const Sizes& sizes, double inflation, std::uint64_t seed) {
  constexpr std::size_t kTerms = 12;
  const Experiment& experiment = *fitter.experiment;
  const auto train = TrainLogs(experiment);
  const ForceTerms terms = RandomForce(kTerms, true, sizes, seed);
  const Problem problem(experiment, without.system(), extra, terms);  // at the model's own step
  const Vector x = Append(fitted.fit.x, std::vector<double>(terms.count, 0.0));
  const ProjectedResidual residual = fitter.ProjectedResidualOf(fitted);
  auto J = ForceColumns(problem, x, fitted.residuals, fitted.sensitivities.value().jacobian,
                        static_cast<Eigen::Index>(terms.count));
  LackOfFit lack;
  lack.force = ChiSquared(residual.Project(J), residual.vector(), inflation);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (train[l]) J[l] = ChannelColumns(problem, problem.Predict(x, l), experiment.logs[l]);
  }
  lack.channel = ChiSquared(residual.Project(J), residual.vector(), inflation);
  return lack;
}

}  // namespace continuum
