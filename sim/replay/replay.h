#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/io/progress.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/score.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// One log, simulated and scored.
struct Replayed {
  Trace trace;
  std::vector<ChannelScore> score;
};

/// Throws Error (file and place) when an experiment names what its model lacks, when its units do
/// not fit, or when a log's known values do not compile: before the first simulation.
void CheckNames(const Experiment& experiment, const ModelSpec& system);

/// Every log of an experiment as it stands; what its registration leaves open is estimated from the
/// train logs and written into it. Throws Error (kJob) when a simulation diverges or finds no rest.
std::vector<Replayed> Replay(Experiment& experiment, const ModelSpec& system,
                             const ProgressCallback& progress = {});

/// Pooled RMS of the train and validate logs.
struct SplitError {
  double train = 0, validate = 0;
};
SplitError PooledError(const Experiment& experiment, const std::vector<Replayed>& logs);
}  // namespace continuum
