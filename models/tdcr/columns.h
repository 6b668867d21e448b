#pragma once

#include "sim/io/csv.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {

/// Keys and columns that nothing reads are a mistake of spelling or of unit more often than a note.
/// @throws Error that names the file, the line and the first of them.
void RequireKnownKeys(const Yaml& robot);
void RequireKnownCaseColumns(const CsvTable& cases, int tendons, int disks);

}  // namespace continuum::tdcr
