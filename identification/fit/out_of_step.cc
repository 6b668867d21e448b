#include "identification/fit/out_of_step.h"

#include <cmath>

#include "identification/fit/fit.h"
#include "identification/statistics/noise_model.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

// What is measured, but for each channel's mean in a log, as residuals would be.
std::vector<Vector> Deviations(const Problem& problem) {
  std::vector<Vector> all;
  for (const Log& log : problem.experiment().logs) {
    Vector r(static_cast<Eigen::Index>(problem.channels().size() * log.rows()));
    auto at = r.begin();
    for (std::size_t c = 0; c < problem.channels().size(); ++c) {
      const std::vector<double>& y = log.measured[problem.channels()[c]];
      double sum = 0, count = 0;
      for (const double v : y)
        if (!std::isnan(v)) sum += v, ++count;
      for (const double v : y) *at++ = std::isnan(v) ? 0 : (v - sum / count) / problem.scale(c);
    }
    all.push_back(std::move(r));
  }
  return all;
}

}  // namespace

bool IsOutOfStep(const Problem& problem, const Vector& x, const std::vector<bool>& use) {
  constexpr double kOfMotion = 0.3;
  const double left = TypicalRms(problem, problem.Residuals(x, use), use);
  return IsFarOver(NoiseOf(problem.experiment()), left) &&
         left > kOfMotion * problem.PooledRms(Deviations(problem), use);
}

}  // namespace continuum
