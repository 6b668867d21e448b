#include "identification/problem/inertia_range.h"

#include <fmt/format.h>

#include "sim/model/inertia_limits.h"

namespace continuum {

void KeepToInertias(const ModelSpec& system, std::vector<FreeParameter>& parameters) {
  constexpr double kInside = 1e-9;  // of the limit
  std::vector<Change> changes;
  for (const FreeParameter& p : parameters) changes.push_back(p.change);
  for (std::size_t n = 0; n < parameters.size(); ++n) {
    const auto limits = InertiaLimits::Of(system, changes, n);
    if (!limits) continue;
    FreeParameter& p = parameters[n];
    const std::size_t i = limits->axis();
    const std::string own = InertiaLimits::Name(i), j = InertiaLimits::Name((i + 1) % 3),
                      k = InertiaLimits::Name((i + 2) % 3);
    const double most = limits->most() * (1 - kInside), least = limits->least() * (1 + kInside);
    if (p.upper > most && limits->HoldAbove()) {
      p.upper = most;
      p.why_upper =
          fmt::format("{} is at most {} + {} = {:.6g}: free these too", own, j, k, limits->most());
    }
    if (p.lower < least && limits->HoldBelow()) {
      p.lower = least;
      p.why_lower = fmt::format("{} is at least |{} − {}| = {:.6g}: free these too", own, j, k,
                                limits->least());
    }
  }
}

}  // namespace continuum
