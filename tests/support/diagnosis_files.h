#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "identification/diagnosis/extension.h"
#include "identification/report/diagnosis_output.h"
#include "sim/io/file.h"
#include "sim/io/json.h"

namespace continuum::testing {

/// All files of a diagnosis, as `continuum diagnose` writes them.
struct DiagnosisFiles {
  ExtensionRun run;
  std::vector<MissingPart> missing;
  nlohmann::json json;  ///< diagnosis.json, read back
};

inline DiagnosisFiles WriteFiles(const Experiment& e, const Diagnosis& d,
                                 const std::filesystem::path& folder) {
  MakeFolder(folder);
  DiagnosisFiles files;
  files.run = MeasureExtension(e, d, folder);
  files.missing = WriteDiagnosis(e, d, files.run, folder);
  files.json = ReadJson(folder / "diagnosis.json");
  return files;
}

}  // namespace continuum::testing
