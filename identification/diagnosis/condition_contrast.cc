#include "identification/diagnosis/condition_contrast.h"

#include <cmath>
#include <limits>

namespace continuum {

double BetweenConditions(const Problem& problem, const std::vector<Problem::Vector>& residuals) {
  const auto& logs = problem.experiment().logs;
  double squares = 0, rows = 0;
  for (std::size_t a = 0; a < logs.size(); ++a) {
    for (std::size_t b = a + 1; b < logs.size(); ++b) {
      if (logs[a].trial != logs[b].trial || logs[a].condition == logs[b].condition) continue;
      if (logs[a].rows() != logs[b].rows()) continue;
      std::vector<Problem::Vector> apart(logs.size());
      std::vector<bool> use(logs.size(), false);
      use[a] = true;
      apart[a] = (residuals[a] - residuals[b]) / std::sqrt(2.0);
      const auto n = static_cast<double>(logs[a].rows());
      squares += n * std::pow(problem.PooledRms(apart, use), 2), rows += n;
    }
  }
  return rows > 0 ? std::sqrt(squares / rows) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace continuum
