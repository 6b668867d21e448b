#pragma once

#include <filesystem>
#include <vector>

#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/result.h"
#include "identification/report/diagnosis_json.h"
#include "identification/report/diagnosis_summary.h"

namespace continuum {

/// Writes the files of a diagnosis into a folder, beside the extended ones that MeasureExtension
/// wrote: fallback.xml, fallback.yaml and next_experiment.csv where there are any, simulated/*.csv,
/// diagnosis.json and report.html. Returns the parts that are missing in them.
std::vector<MissingPart> WriteDiagnosis(const Experiment& experiment, const Diagnosis& diagnosis,
                                        const ExtensionRun& run,
                                        const std::filesystem::path& folder);

/// Writes report.html. Parts that cannot be made leave a badge at their place and are added to
/// `missing`.
void WriteDiagnosisReport(const Experiment& experiment, const Diagnosis& diagnosis,
                          const ExtensionRun& run, const std::filesystem::path& file,
                          std::vector<MissingPart>& missing);

}  // namespace continuum
