#include "identification/report/fit_output.h"

#include <nlohmann/json.hpp>

#include "identification/report/fit_json.h"
#include "identification/report/fit_report.h"
#include "identification/report/parts.h"
#include "sim/io/file.h"
#include "sim/replay/replay_report.h"

namespace continuum {

std::vector<MissingPart> WriteFit(const Experiment& e, const IdentifyResult& result,
                                  const std::filesystem::path& folder) {
  MakeFolder(folder);
  std::vector<MissingPart> missing = result.missing;
  nlohmann::json json = FitJson(e, result, missing);
  const bool whole = MakePart("simulated", missing, [&] { RequireWhole(e, result.logs); });
  AddMissing(json, missing);
  WriteFile(folder / "fit.json", json.dump(2) + "\n");
  WriteOrRemove(folder / "fitted.xml", result.fitted.xml);
  WriteOrRemove(folder / "fitted.yaml", result.fitted.yaml);
  if (whole) {
    std::vector<Trace> traces;
    for (const Replayed& log : result.logs) traces.push_back(log.trace);
    WriteSimulated(e, traces, folder / "simulated");
  }
  WriteFitReport(e, result, folder / "report.html", missing);
  return missing;
}

}  // namespace continuum
