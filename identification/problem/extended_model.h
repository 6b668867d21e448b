#pragma once

#include <filesystem>
#include <string>

#include "identification/problem/problem.h"
#include "identification/result/extended_model.h"

namespace continuum {

/// Writes the model of a problem at the parameters x as MJCF, to stand in a folder under the name
/// `model`, and its experiment. whole: the model that the problem was made of, with the geoms that
/// it simulates without. Values that logs set themselves, the measurement and where trials
/// begin are written as they are at x, so that both files together simulate what was fitted.
ExtendedModel Extend(const Problem& problem, const ModelSpec& whole, const Problem::Vector& x,
                     const std::filesystem::path& folder,
                     const std::string& model = "extended.xml");

}  // namespace continuum
