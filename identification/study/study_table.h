#pragma once

#include <string>
#include <vector>

#include "identification/study/study_row.h"

namespace continuum {

/// What rows do that do not say it.
struct StudyDefaults {
  std::string command, options;
};

/// Reads a study: one table (CSV, or YAML with `rows`), or experiments by names and patterns.
///
/// Columns of a CSV: `experiment`, and as wanted `command`, `options`, `name`; all others are
/// labels. Keys of a YAML: `command`, `options` for all, and `rows` with the same and `labels`. An
/// experiment may be a pattern, which gives one row for each file in the order of their names.
///
/// What is wrong with one row is its `fault`. Throws Error when the table cannot be read at all.
StudyTable ReadStudy(const std::vector<std::string>& sources, const StudyDefaults& defaults);

}  // namespace continuum
