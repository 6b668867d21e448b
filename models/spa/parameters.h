#pragma once

#include <filesystem>

#include "models/spa/spa.h"

namespace continuum {

/// What models/spa/spa.yaml holds.
struct SpaFile {
  SpaParameters<double> parameters;
  SpaOptions options;
};

/// Reads such a file. Throws Error with file, line and key for missing or unknown keys, lengths,
/// area or mass that are not positive, and negative lag, damping or linear stiffness.
SpaFile ReadSpa(const std::filesystem::path& file);

}  // namespace continuum
