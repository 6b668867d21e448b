#pragma once

#include <filesystem>

#include "sim/model/model_spec.h"

namespace continuum {

/// A model of the user's. What its effects warn of goes to stderr.
ModelSpec LoadModel(const std::filesystem::path& model);

}  // namespace continuum
