#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hidden_effects/tally.h"

namespace continuum::hidden {

/// Matrices below each other as an SVG file, darker where a larger share of the row lies.
std::string MatricesSvg(const std::vector<Matrix>& matrices);

/// confusion.svg, power.svg and calibration.svg (reliability and coverage) of a run.
void WritePictures(const std::vector<Outcome>& outcomes, const std::filesystem::path& folder);

}  // namespace continuum::hidden
