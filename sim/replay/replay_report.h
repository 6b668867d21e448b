#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/page/page.h"
#include "sim/replay/replay.h"

namespace continuum {

/// "error 0.1 m RMS on train, 0.2 on validate", of the uses that logs have.
std::string ErrorText(const Experiment& experiment, const SplitError& error);

/// errors.json: pooled errors, per log and channel what ChannelScore holds, and what ScoreSensors
/// says.
nlohmann::json ErrorsJson(const Experiment& experiment, const std::vector<Replayed>& logs);
/// [channels] of one log as JSON.
nlohmann::json ScoreJson(const std::vector<ChannelScore>& score);

/// simulated/<log>.csv: time [s], and per channel the simulated and the measured value in its unit.
/// Files of logs that an earlier job wrote there and this experiment lacks go (OutputManifest).
void WriteSimulated(const Experiment& experiment, const std::vector<Trace>& traces,
                    const std::filesystem::path& folder);

struct NamedTrace {
  std::string name;
  Style style;
  const Trace* trace;
};
/// Adds one panel per counted channel of a log (or only for one): measured and the named traces.
void AddOverlay(Page& page, const Experiment& experiment, const Log& log,
                const std::vector<NamedTrace>& traces, bool residual, const std::string& only = "");

void WriteReplayReport(const Experiment& experiment, const std::vector<Replayed>& logs,
                       const std::filesystem::path& file);

}  // namespace continuum
