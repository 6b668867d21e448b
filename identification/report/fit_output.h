#pragma once

#include <filesystem>
#include <vector>

#include "identification/result/identify_result.h"

namespace continuum {

/// Writes the files of a fit into a folder: fit.json, fitted.xml, fitted.yaml (the experiment with
/// that model and every value that was fitted of single logs or of the measurement),
/// simulated/*.csv and report.html. A part that cannot be made costs only itself. Returns all that
/// is missing, also of the result. Throws Error where a file cannot be written.
std::vector<MissingPart> WriteFit(const Experiment& experiment, const IdentifyResult& result,
                                  const std::filesystem::path& folder);

}  // namespace continuum
