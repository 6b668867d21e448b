#include "identification/diagnosis/condition_contrast.h"

#include <cmath>

namespace continuum {

std::optional<double> ConditionContrast(const Problem& problem,
                                        const std::vector<Problem::Vector>& residuals) {
  const auto& logs = problem.experiment().logs;
  double squares = 0, rows = 0;
  for (std::size_t a = 0; a < logs.size(); ++a) {
    for (std::size_t b = a + 1; b < logs.size(); ++b) {
      if (logs[a].trial != logs[b].trial || logs[a].condition == logs[b].condition) continue;
      if (logs[a].rows() != logs[b].rows()) continue;
      std::vector<Problem::Vector> difference(logs.size());
      std::vector<bool> use(logs.size(), false);
      use[a] = true;
      difference[a] = (residuals[a] - residuals[b]) / std::sqrt(2.0);
      const auto n = static_cast<double>(logs[a].rows());
      squares += n * std::pow(problem.PooledRms(difference, use), 2), rows += n;
    }
  }
  if (rows == 0) return {};
  return std::sqrt(squares / rows);
}

}  // namespace continuum
