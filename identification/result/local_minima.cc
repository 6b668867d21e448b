#include "identification/result/local_minima.h"

#include <algorithm>

#include <fmt/format.h>

namespace continuum {

std::string LocalMinima::Doubts(const Eigen::VectorXd& x, double cost, const Uncertainty& u,
                                const std::vector<FreeParameter>& parameters) const {
  constexpr double kAsWell = 0.01;  // of the cost
  std::string ranges;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double low = x[i], high = x[i];
    for (const LocalMinimum& other : found) {
      if (other.cost <= (1 + kAsWell) * cost)
        low = std::min(low, other.x[i]), high = std::max(high, other.x[i]);
    }
    if (low >= u.lower[i] && high <= u.upper[i]) continue;
    ranges += fmt::format("{}{} {:.4g} … {:.4g}", ranges.empty() ? "" : ", ", parameters[i].name,
                          low, high);
  }
  if (ranges.empty()) return "";
  return fmt::format(
      "several minima: {} fit as well within {:.0f} %, so intervals, which allow for one of them, "
      "are not to be trusted",
      ranges, 100 * kAsWell);
}

}  // namespace continuum
