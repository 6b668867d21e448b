#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <mujoco/mujoco.h>

#include "effects/effect.h"
#include "sim/model/change.h"

namespace continuum {

class SpecElement;

/// Whether the target is the model as a whole: "option", or "world" as the place of an effect
/// ("world:*" too).
bool IsWorld(std::string_view target);

/// Whether the change is a parameter of a native effect: "effect:NAME" or "effect:NAME.PARAM".
bool IsNativeEffect(const Change& change);
/// Whether an earlier change is of the same effect at the same target, which acts for all of them.
bool RepeatsEffect(std::span<const Change> changes, std::size_t index);

/// Applies the effect of `change` with the values that `changes` give its parameters. Throws Error
/// when there is no native effect or parameter of this name.
void ApplyNativeEffect(SpecElement& element, std::span<const Change> changes, const Change& change);
void ApplyNativeEffect(mjOption& world, std::span<const Change> changes, const Change& change);

/// Index of a parameter on the card of an effect, by the name of its plugin ("continuum.dahl").
/// Throws Error when the effect has none of this name.
std::size_t ParameterIndex(const std::string& plugin, const std::string& parameter);

/// What the card of a native effect says of a parameter.
Param ParameterOfNativeEffect(const std::string& attribute);
/// The value of a parameter at which its effect is absent; 0 when that is what the model has.
double NullOfNativeEffect(const std::string& attribute);
/// Whether steps of the model's own length are needed to show it (effect.h: kOwnStep).
bool NativeEffectNeedsOwnStep(const std::string& attribute);
/// Its unit, of what turns.
std::string UnitOfNativeEffect(const std::string& attribute);

}  // namespace continuum
