#include "identification/diagnosis/correction.h"

#include <algorithm>
#include <cmath>

namespace continuum {

double MayBeOff(std::string_view effect, std::string_view parameter, double null,
                const Sizes& sizes, const Criteria& criteria) {
  if (!std::isfinite(null)) return 0;
  if (null != 0) return criteria.correction * std::abs(null);
  if (effect == "clock_skew") return criteria.whole_correction;
  const bool adds_mass = effect == "payload" && parameter.starts_with("mass");
  return adds_mass ? criteria.whole_correction * sizes.robot : 0;
}

bool OnlyCorrects(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin, const Sizes& sizes,
                  const Criteria& criteria) {
  const auto amplitudes = h.Amplitudes();
  return std::all_of(amplitudes.begin(), amplitudes.end(), [&](std::size_t i) {
    const double change = fitted.fit.x[begin + static_cast<Eigen::Index>(i)] - h.null[i];
    return std::abs(change) <= MayBeOff(h.Card(), h.extra[i].name, h.null[i], sizes, criteria);
  });
}

}  // namespace continuum
