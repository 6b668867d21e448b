#pragma once

#include <string>
#include <vector>

#include "sim/io/csv.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {

/// The format lets a file carry keys and columns beside its own, so these are not refused, but
/// whoever meant one of the optional names has to hear of it: one sentence each, with file and
/// line.
std::vector<std::string> UnusedKeys(const Yaml& robot);
std::vector<std::string> UnusedCaseColumns(const CsvTable& cases, int tendons);
std::vector<std::string> UnusedMeasuredColumns(const CsvTable& measured, int disks);

/// @throws Error for a column of CASES.csv that is one of its names but for case, blanks and
/// underscores, or a tendon's number.
void RejectMisspelt(const CsvTable& cases, int tendons);

}  // namespace continuum::tdcr
