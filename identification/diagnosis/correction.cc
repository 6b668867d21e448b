#include "identification/diagnosis/correction.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

constexpr double kGravity = 9.81;  // m/s²

}  // namespace

double MayBeOff(const EffectInfo& effect, std::string_view parameter, double null,
                const Sizes& sizes, const Criteria& criteria) {
  if (!std::isfinite(null)) return 0;
  if (null != 0) return criteria.correction * std::abs(null);
  const std::string_view name = parameter.substr(0, parameter.find('['));  // of a condition
  for (const Param& param : effect.params) {
    if (param.name != name) continue;
    if (effect.kind == EffectInfo::Kind::kEdit && param.unit == "kg")
      return criteria.whole_correction * sizes.robot;
    if (effect.kind == EffectInfo::Kind::kEdit && param.unit == "N")
      return criteria.whole_correction * kGravity * sizes.robot;
    if (param.unit == "output") return criteria.whole_correction * sizes.reading;
    const bool direction = effect.places.front() == Place::kWorld && param.unit == "rad";
    const bool clock = effect.kind == EffectInfo::Kind::kMeasure && param.unit == "1";
    return direction || clock ? +criteria.whole_correction : 0;
  }
  return 0;
}

bool OnlyCorrects(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin,
                  const Experiment& experiment, Sizes sizes, const Criteria& criteria) {
  const EffectInfo& effect = EffectNamed(h.Card());
  if (h.place == Place::kSensor) sizes.reading = ReadingSize(experiment, h.objects);
  const auto amplitudes = h.Amplitudes();
  return std::all_of(amplitudes.begin(), amplitudes.end(), [&](std::size_t i) {
    const double change = fitted.fit.x[begin + static_cast<Eigen::Index>(i)] - h.null[i];
    return std::abs(change) <= MayBeOff(effect, h.extra[i].name, h.null[i], sizes, criteria);
  });
}

}  // namespace continuum
