#include "models/statics/plausible.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace continuum::statics {

void WarnIfImplausible(const SolveRequest& request, const std::string& where, double value,
                       double low, double high, const std::string& unit) {
  const double size = std::abs(value);
  if (size == 0 || (size >= low && size <= high)) return;
  const std::string space = unit.empty() ? "" : " ";
  request.warn(fmt::format("{}: {:.4g}{}{} is implausible, expected {:.3g} to {:.3g}{}{}", where,
                           value, space, unit, low, high, space, unit));
}

void WarnIfDegrees(const SolveRequest& request, const std::string& where, double angle) {
  if (std::abs(angle) <= 2 * std::numbers::pi + 1e-6) return;
  request.warn(fmt::format(
      "{}: {:.4g} is taken as radians, expected -2 pi to 2 pi; {:.4g} degrees are {:.6g} rad",
      where, angle, angle, angle * std::numbers::pi / 180));
}

}  // namespace continuum::statics
