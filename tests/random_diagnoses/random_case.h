#pragma once

#include <cstdint>
#include <filesystem>

namespace continuum::random_diagnoses {

/// Writes a random model, logs of it as it truly is, and an experiment that is to be diagnosed into
/// a folder, which must exist. Some logs are odd: cells without a number, few rows, channels that
/// never change, one trial, replicates with clocks of their own. Repeats exactly for a seed.
/// Returns the experiment's path.
std::filesystem::path WriteRandomCase(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace continuum::random_diagnoses
