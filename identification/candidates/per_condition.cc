#include "identification/candidates/per_condition.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "error.h"

namespace continuum {

std::set<std::string> TrainedConditions(const Experiment& e, const std::string& candidate) {
  const std::string where = fmt::format("{}: candidates: {}: per", e.file.string(), candidate);
  std::set<std::string> all, trained;
  for (const Log& log : e.logs) {
    if (log.condition.empty()) continue;
    all.insert(log.condition);
    if (log.train) trained.insert(log.condition);
  }
  if (all.size() < 2)
    throw Error::Input(where, "logs of two conditions or more", std::to_string(all.size()));
  for (const std::string& name : all) {
    if (!trained.contains(name))
      throw Error::Input(where, "a train log of every condition", "none of '" + name + "'");
  }
  return all;
}

void SplitByCondition(Hypothesis& h, const std::set<std::string>& conditions) {
  std::vector<Parameter> extra;
  std::vector<double> null;
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    for (const std::string& name : conditions) {
      extra.push_back(h.extra[i]);
      extra.back().name += "[" + name + "]";
      extra.back().condition = name;
      null.push_back(h.null[i]);
    }
  }
  h.extra = std::move(extra), h.null = std::move(null);
  h.where += ", per condition";
}

}  // namespace continuum
