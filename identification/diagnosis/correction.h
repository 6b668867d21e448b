#pragma once

#include <string_view>

#include "binding/effect_catalog.h"
#include "identification/diagnosis/criteria.h"
#include "identification/diagnosis/lengths_and_masses.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// How far the number of the model may be off that a parameter of an effect changes, null where the
/// effect is absent: masses, gains and stiffnesses by a few per cent, the mass of the whole robot,
/// its weight, what a joint moves, the direction of gravity, the clock or the zero of a sensor by
/// less. 0 where there is no such number.
double MayBeOff(const EffectInfo& effect, std::string_view parameter, double null,
                const Sizes& sizes, const Criteria& criteria);

/// Whether a fitted candidate only changes numbers that the model has, by so little as they may
/// well be off. begin: of its parameters in the fit.
bool OnlyCorrects(const Hypothesis& hypothesis, const Fitted& fitted, Eigen::Index begin,
                  const Experiment& experiment, Sizes sizes, const Criteria& criteria);

/// Whether lengths and masses that are a little off, by no more than twice link_known, explain so
/// much [squares] that another cause, which explains this much in their place, is none of its own.
bool MayBeLengthsAndMasses(const ByLengthsAndMasses& by, double other, const Criteria& criteria);

/// Whether lengths and masses that are a little off do all that shows [squares], and clearly more
/// than the best cause: one that is enough by itself stands.
bool AreNumbersEnough(const ByLengthsAndMasses& by, double shows, double best,
                      const Criteria& criteria);

/// Whether a factor on a number of the model is further from 1 than such numbers are off.
bool IsFarOff(double factor, const Criteria& criteria);
/// Whether a tilt of the whole robot [rad] would have been seen.
bool IsFarTilt(double tilt, const Criteria& criteria);
/// Whether a clock that is off by this share of time would be the worst of its kind.
bool IsFarClock(double skew, const Criteria& criteria);

/// Whether a fitted candidate has such a size, which is not plausible.
bool IsFarOff(const Hypothesis& hypothesis, const Fitted& fitted, Eigen::Index begin,
              const Criteria& criteria);

}  // namespace continuum
