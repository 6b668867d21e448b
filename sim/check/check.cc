#include "sim/check/check.h"

#include <utility>

#include "sim/check/checked_log.h"
#include "sim/check/rules.h"

namespace continuum {

std::vector<Finding> CheckLogs(const Experiment& e) {
  Findings plan(nullptr);
  CheckPlan(e, plan);
  std::vector<Finding> all = plan.Take();
  for (const CheckedLog& log : PrepareLogs(e)) {
    Findings found(log.log);
    CheckClock(log, found);
    CheckColumns(log, found);
    CheckExcitation(log, found);
    CheckPairs(log, found);
    for (Finding& f : found.Take()) all.push_back(std::move(f));
  }
  return all;
}

}  // namespace continuum
