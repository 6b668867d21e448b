#include "identification/diagnosis/look_logs.h"

#include <algorithm>

#include "identification/problem/problem.h"

namespace continuum {

std::vector<bool> LogsForALook(const Experiment& e) {
  constexpr std::size_t kRows = 4000;
  const std::vector<bool> train = TrainLogs(e);
  std::size_t rows = 0, logs = 0;
  for (std::size_t l = 0; l < train.size(); ++l) {
    if (train[l]) rows += e.logs[l].rows(), ++logs;
  }
  const std::size_t every = std::max<std::size_t>(1, std::min(logs / 2, rows / kRows));
  std::vector<bool> use(train.size(), false);
  for (std::size_t l = 0, nth = 0; l < train.size(); ++l) {
    if (train[l]) use[l] = nth++ % every == 0;
  }
  return use;
}

}  // namespace continuum
