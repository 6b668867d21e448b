#pragma once

#include <filesystem>

#include "models/spa/experiment.h"
#include "models/spa/parameters.h"

namespace continuum {

/// Writes steps of the analytic model, with the masses along the arc as in a chain, as noisy logs
/// of 200 Hz, and an experiment over spa.xml of the same values that fits the ten parameters of the
/// paper's Table I from 20 to 50 % off to tip, force and torque. Pressures are those asked for.
void WriteSpaLogs(const SpaFile& truth, const SpaNoise& noise, unsigned seed,
                  const std::filesystem::path& folder);

}  // namespace continuum
