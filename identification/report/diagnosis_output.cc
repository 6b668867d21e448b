#include "identification/report/diagnosis_output.h"

#include <nlohmann/json.hpp>

#include "identification/report/parts.h"
#include "sim/io/file.h"
#include "sim/replay/replay.h"
#include "sim/replay/replay_report.h"

namespace continuum {
std::vector<MissingPart> WriteDiagnosis(const Experiment& e, const Diagnosis& d,
                                        const ExtensionRun& run,
                                        const std::filesystem::path& folder) {
  std::vector<MissingPart> missing = d.missing;
  missing.insert(missing.end(), run.missing.begin(), run.missing.end());
  WriteOrRemove(folder / kFallbackModel, run.fallback ? run.fallback->xml : "");
  WriteOrRemove(folder / kFallbackExperiment, run.fallback ? run.fallback->yaml : "");
  WriteOrRemove(folder / kNextInputs, run.next_inputs);
  if (!run.after_traces.empty() &&
      MakePart("simulated", missing, [&] { RequireWhole(e, run.after_traces); }))
    WriteSimulated(e, run.after_traces, folder / "simulated");
  nlohmann::json json = DiagnosisJson(e, d, run, missing);
  AddMissing(json, missing);
  WriteFile(folder / "diagnosis.json", json.dump(2) + "\n");
  WriteDiagnosisReport(e, d, run, folder / "report.html", missing);
  return missing;
}

}  // namespace continuum
