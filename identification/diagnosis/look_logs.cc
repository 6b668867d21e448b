#include "identification/diagnosis/look_logs.h"

#include <algorithm>
#include <set>

#include "identification/problem/problem.h"

namespace continuum {
namespace {

// Train logs, the first of every trial before its replicates, which show the same.
std::vector<std::size_t> InOrder(const Experiment& e) {
  std::vector<std::size_t> firsts, others;
  std::set<std::string> trials;
  const std::vector<bool> train = TrainLogs(e);
  for (std::size_t l = 0; l < train.size(); ++l) {
    if (!train[l]) continue;
    const bool is_first = e.logs[l].trial.empty() || trials.insert(e.logs[l].trial).second;
    (is_first ? firsts : others).push_back(l);
  }
  if (firsts.size() < 2) firsts.insert(firsts.end(), others.begin(), others.end());
  return firsts;
}

}  // namespace

std::vector<bool> LogsForALook(const Experiment& e, double step) {
  constexpr std::size_t kRows = 1500, kSteps = 40'000;
  const std::vector<std::size_t> logs = InOrder(e);
  std::size_t rows = 0;
  double seconds = 0;
  for (const std::size_t l : logs) {
    rows += e.logs[l].rows();
    seconds += e.logs[l].time.back() - e.logs[l].time.front();
  }
  const auto steps = static_cast<std::size_t>(e.quasi_static ? 0 : seconds / step);
  const std::size_t times = std::max(rows / kRows, steps / kSteps);  // too many
  const std::size_t every = std::max<std::size_t>(1, std::min(logs.size() / 2, times));
  std::vector<bool> use(e.logs.size(), false);
  for (std::size_t i = 0; i < logs.size(); i += every) use[logs[i]] = true;
  return use;
}

}  // namespace continuum
