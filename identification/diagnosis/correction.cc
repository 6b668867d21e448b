#include "identification/diagnosis/correction.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

constexpr double kGravity = 9.81;  // m/s²

// On the card of an effect; null where it is none of its parameters.
const Param* OnCard(const EffectInfo& effect, std::string_view parameter) {
  const std::string_view name = parameter.substr(0, parameter.find('['));  // of a condition
  const auto at = std::find_if(effect.params.begin(), effect.params.end(),
                               [&](const Param& one) { return one.name == name; });
  return at == effect.params.end() ? nullptr : &*at;
}

// Of a pure number: a parameter of the model that is scaled, or one of the effect's card.
bool IsNumber(const Parameter& p, const EffectInfo& effect) {
  const Param* const param = OnCard(effect, p.name);
  return p.unit == "1" || (param && param->unit == "1");
}

// Of gravity: of the whole robot.
bool IsTilt(const EffectInfo& effect, const Param& param) {
  return effect.places.front() == Place::kWorld && param.unit == "rad";
}

// The clock's rate.
bool IsClock(const EffectInfo& effect, const Param& param) {
  return effect.kind == EffectInfo::Kind::kMeasure && param.null == 0 && param.unit == "1";
}

}  // namespace

double MayBeOff(const EffectInfo& effect, std::string_view parameter, double null,
                const Sizes& sizes, const Criteria& criteria) {
  if (!std::isfinite(null)) return 0;
  const Param* const param = OnCard(effect, parameter);
  const double share = criteria.correction * std::abs(null);
  if (effect.kind == EffectInfo::Kind::kEdit && param && param->unit == "kg*m^2")
    return std::max(share, criteria.whole_correction * sizes.inertia);
  if (effect.places.front() == Place::kBody && param && param->unit == "1")
    return std::max(share, criteria.whole_correction * sizes.robot / sizes.mass);
  if (null != 0) return share;
  if (!param) return 0;
  if (effect.kind == EffectInfo::Kind::kEdit && param->unit == "kg")
    return criteria.whole_correction * sizes.robot;
  if (effect.kind == EffectInfo::Kind::kEdit && param->unit == "N")
    return criteria.whole_correction * kGravity * sizes.robot;
  if (param->unit == "output") return criteria.whole_correction * sizes.reading;
  return IsTilt(effect, *param) || IsClock(effect, *param) ? +criteria.whole_correction : 0;
}

bool OnlyCorrects(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin,
                  const Experiment& experiment, Sizes sizes, const Criteria& criteria) {
  const EffectInfo& effect = EffectNamed(h.Card());
  if (h.place == Place::kSensor) sizes.reading = ReadingSize(experiment, h.objects);
  if (h.place == Place::kBody) sizes.mass = MassOf(h.system.model(), h.objects);
  if (h.place == Place::kJoint) sizes.inertia = InertiaOf(h.system.model(), h.objects);
  const auto amplitudes = h.Amplitudes();
  return std::all_of(amplitudes.begin(), amplitudes.end(), [&](std::size_t i) {
    const double change = fitted.fit.x[begin + static_cast<Eigen::Index>(i)] - h.null[i];
    return std::abs(change) <= MayBeOff(effect, h.extra[i].name, h.null[i], sizes, criteria);
  });
}

bool MayBeLengthsAndMasses(const ByLengthsAndMasses& by, double other, const Criteria& criteria) {
  return by.off <= 2 * criteria.link_known && by.squares >= criteria.correction_share * other;
}

bool AreNumbersEnough(const ByLengthsAndMasses& by, double shows, double best,
                      const Criteria& criteria) {
  const double margin =
      criteria.rival_margin + criteria.parameter_cost * static_cast<double>(by.numbers);
  return by.off > 0 && by.off <= criteria.numbers_most && by.squares > best + margin &&
         by.squares >= criteria.numbers_share * shows;
}

bool IsFarOff(double factor, const Criteria& criteria) {
  return factor > criteria.factor_most || factor * criteria.factor_most < 1;
}

bool IsFarTilt(double tilt, const Criteria& criteria) {
  return std::abs(tilt) > criteria.tilt_most;
}

bool IsFarClock(double skew, const Criteria& criteria) {
  return std::abs(skew) > criteria.clock_most;
}

bool IsFarOff(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin,
              const Criteria& criteria) {
  const EffectInfo& effect = EffectNamed(h.Card());
  const auto amplitudes = h.Amplitudes();
  return std::any_of(amplitudes.begin(), amplitudes.end(), [&](std::size_t i) {
    const double value = fitted.fit.x[begin + static_cast<Eigen::Index>(i)];
    const Param* const param = OnCard(effect, h.extra[i].name);
    if (param && IsTilt(effect, *param)) return IsFarTilt(value, criteria);
    if (param && IsClock(effect, *param)) return IsFarClock(value, criteria);
    return h.null[i] == 1 && IsNumber(h.extra[i], effect) && IsFarOff(value, criteria);
  });
}

}  // namespace continuum
