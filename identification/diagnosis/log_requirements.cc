#include "identification/diagnosis/log_requirements.h"

#include <algorithm>

#include "error.h"
#include "identification/statistics/noise_model.h"

namespace continuum {

void RequireTrainLogs(const Experiment& e) {
  const bool any =
      std::any_of(e.logs.begin(), e.logs.end(), [](const Log& log) { return log.train; });
  if (!any) throw Error::Input(e.file.string() + ": logs", "at least one with use: train", "none");
}

void RequireOwnRecordings(const Experiment& e) {
  for (const auto& group : ReplicateGroups(e)) {
    for (std::size_t b = 1; b < group.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        const Log &first = e.logs[group[a]], &copy = e.logs[group[b]];
        if (first.measured != copy.measured) continue;
        throw Error::Input(copy.file.string(), "a recording of its own",
                           "the values of " + first.file.string() + ": a copy is no replicate");
      }
    }
  }
}

void RequireFolds(const Experiment& e, const std::vector<Fold>& folds) {
  if (!folds.empty()) return;
  throw Error::Input(e.file.string() + ": folds",
                     "at least two groups of logs to leave out in turn", "one");
}

}  // namespace continuum
