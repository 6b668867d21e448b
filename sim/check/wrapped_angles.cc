#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"
#include "sim/io/units.h"

namespace continuum {

bool CheckWrapped(const CheckedColumn& c, Findings& out) {
  const Unit unit = ParseUnit(c.unit, "");
  if (!c.smooth || !unit.IsAngle()) return false;
  const double turn = 2 * std::numbers::pi / unit.factor;
  if (RangeOf(c.value) > 1.02 * turn) return false;
  std::vector<std::size_t> places;
  for (std::size_t k = 1; k < c.value.size(); ++k) {
    const double step = std::abs(c.value[k] - c.value[k - 1]);
    if (std::abs(step - turn) < 0.25 * turn) places.push_back(k);
  }
  if (places.empty()) return false;
  const auto place = [&](std::size_t k) {
    return fmt::format("row {} (t = {})", c.row[k] + 1, Clock(c.time[k]));
  };
  out.Add(
      Finding::Severity::kWarning, c.name, "wrapped",
      fmt::format("jumps by a full turn in {} of {} rows, an angle that is kept within one turn: "
                  "write `unwrap: true` beside its unit; {}",
                  places.size(), c.value.size(), place(places.front())),
      c.time[places.front()], c.time[places.front()], FurtherPlaces(places, places.size(), place));
  return true;
}

}  // namespace continuum
