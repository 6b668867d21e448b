#pragma once

#include <vector>

#include "identification/result/folds.h"
#include "sim/experiment/experiment.h"

// What a diagnosis needs of an experiment's logs.
namespace continuum {

/// Throws Error where no log is trained on.
void RequireTrainLogs(const Experiment& experiment);

/// Throws Error where a replicate is a copy: the noise between copies is none.
void RequireOwnRecordings(const Experiment& experiment);

/// Throws Error where there is nothing to leave out in turn: without noise nothing else judges.
void RequireFolds(const Experiment& experiment, const std::vector<Fold>& folds);

}  // namespace continuum
