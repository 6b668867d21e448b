#include "identification/candidates/nuisance_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "identification/candidates/parameter_size.h"
#include "identification/candidates/unit_powers.h"

namespace continuum {
namespace {

constexpr double kMost = 7;                       // values
const double kRatio = std::pow(10.0, 1.0 / 3.0);  // of two neighbours: three per decade
constexpr double kSamples = 3;                    // a time of fewer is none that the rows show
constexpr double kWidest = 1.5;                   // a width of 1/1.5 of the range
constexpr double kNarrowest = 500;

struct Range {
  double low, high;
  double ratio = kRatio;
};

// What the logs can show of a parameter; nothing of most units.
std::optional<Range> RangeOf(const Powers& powers, Place place, const ParameterSize& size,
                             const Sizes& s) {
  const double longest = std::max(s.duration, kSamples * s.period);
  // A limit that the largest force comes near; one that holds most of the time is another machine.
  if (powers == PowersOf("N*m") && place == Place::kActuator)
    return Range{0.33 * size.size, 0.95 * size.size, 1.2};
  if (powers == PowersOf("s")) return Range{kSamples * s.period, longest};
  if (powers == PowersOf("rad/s") && place == Place::kActuator)
    return Range{1 / longest, 1 / s.period};
  if (powers == PowersOf("rad/s")) return Range{0.01 * size.size, 1.5 * size.size};
  // Sizes of these belong to a fiftieth of the range.
  if (powers == PowersOf("1/rad") || powers == PowersOf("N*m/rad"))
    return Range{kWidest / 50 * size.size, kNarrowest / 50 * size.size};
  return {};
}

}  // namespace

NuisanceGrid GridOf(const Param& param, Place place, const Sizes& sizes) {
  const ParameterSize size = SizeOf(param, place, sizes);
  const double typical = 0.3 * size.size;
  const auto range = RangeOf(PowersOf(param.unit), place, size, sizes);
  const double low = range ? range->low : typical / 5, high = range ? range->high : 5 * typical;
  const double ratio = range ? std::max(range->ratio, std::pow(high / low, 1 / (kMost - 1))) : 5;
  NuisanceGrid grid{low < typical && typical < high ? typical : std::sqrt(low * high), {}};
  const auto steps = [&](double to) {
    return std::round(std::log(to / grid.start) / std::log(ratio));
  };
  const double last = steps(high);
  for (double k = steps(low); k <= last; ++k)
    grid.values.push_back(grid.start * std::pow(ratio, k));
  return grid;
}

}  // namespace continuum
