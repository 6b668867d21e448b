#pragma once

#include <string>
#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Throws Error (kInput) when two logs are the same rows of one file, whatever they are called:
/// as replicates they would show a noise of zero, as train and validate logs a model tested
/// on what it was fitted to, and one measurement has only one condition. Windows may touch. where:
/// file:line of each log, for the message.
void RefuseRepeatedLogs(const std::vector<Log>& logs, const std::vector<std::string>& where);

}  // namespace continuum
