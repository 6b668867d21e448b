#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "identification/result/missing_parts.h"
#include "sim/page/page.h"
#include "sim/replay/replay.h"

namespace continuum {

/// Adds one part to a page. An exception costs that part alone: a badge that says so stands at its
/// place, and the part is added to `missing`.
void AddPart(Page& page, const std::string& name, std::vector<MissingPart>& missing,
             const std::function<void()>& content);

/// Adds a badge for each part of this name that could not be computed; nothing where none is.
void AddMissing(Page& page, const std::string& name, const std::vector<MissingPart>& missing);

/// Writes "missing": ["NAME: WHY"] into the JSON of a result; nothing where nothing is missing.
void AddMissing(nlohmann::json& json, const std::vector<MissingPart>& missing);

/// "not in the report: NAME: WHY", a line for each part; empty where nothing is missing.
std::string MissingInWords(const std::vector<MissingPart>& missing);

/// Throws Error (kJob) where simulated logs lack channels or rows of the experiment, or a result
/// lacks entries: "standard errors: 2 of 3".
void RequireWhole(const Experiment& experiment, const std::vector<Trace>& logs);
void RequireWhole(const Experiment& experiment, const std::vector<Replayed>& logs);
void RequireCount(const std::string& what, std::size_t found, std::size_t expected);

}  // namespace continuum
