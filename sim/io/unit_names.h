#pragma once

#include <optional>
#include <string_view>

#include "sim/io/unit.h"

namespace continuum {

/// The unit that one name stands for, with or without a prefix of the SI: "mm", "millimetre",
/// "psi", "deg". Nothing for a name that is none.
std::optional<Unit> UnitNamed(std::string_view name);

}  // namespace continuum
