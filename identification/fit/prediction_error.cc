#include "identification/fit/prediction_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "identification/fit/multiple_shooting.h"
#include "sim/simulation/initial_state.h"
#include "sim/simulation/score.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

constexpr std::size_t kMostStarts = 100;  // starts in a log

struct Sum {
  double squares = 0;
  std::size_t count = 0;

  void Add(double error) {
    if (!std::isnan(error)) squares += error * error, ++count;
  }
  double Root() const {
    return count > 0 ? std::sqrt(squares / static_cast<double>(count))
                     : std::numeric_limits<double>::quiet_NaN();
  }
};

// [row] what free simulation of a log remembers at every stride-th row, as far as it comes.
std::map<std::size_t, std::vector<double>> Memories(const Problem& problem,
                                                    const Problem::Vector& x, std::size_t log,
                                                    std::size_t stride) {
  std::map<std::size_t, std::vector<double>> memories;
  Hooks hooks;
  hooks.row = [&](const mjModel& m, const mjData& d, std::size_t row) {
    if (row % stride == 0) memories[row] = MemoryOf(m, d);
  };
  ModelAndData machine = problem.system().Build(problem.ChangesFor(x, log));
  const InitialState start = problem.StartAt(machine, x, log);
  Simulate(machine, problem.MeasuredBy(x, log), problem.experiment().logs[log], start, hooks);
  return memories;
}

}  // namespace

std::optional<PredictionError> PredictAhead(const Problem& problem, const Problem::Vector& x,
                                            std::size_t rows) {
  const Experiment& e = problem.experiment();
  if (e.quasi_static) return {};  // its rows know no time
  std::vector<Sum> sums[2] = {std::vector<Sum>(e.channels.size()),
                              std::vector<Sum>(e.channels.size())};
  std::vector<double> seconds;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Log& log = e.logs[l];
    const Experiment measured = problem.MeasuredBy(x, l);
    const auto changes = problem.ChangesFor(x, l);
    const std::size_t stride = std::max(rows, log.rows() / kMostStarts);
    auto memories = Memories(problem, x, l, stride);
    const ModelAndData fitted = problem.system().Build(changes);
    for (std::size_t first = 0; first + rows < log.rows(); first += stride) {
      auto state = StateAt(*fitted.model, measured, log, first);
      if (!state) continue;
      state->memory = std::move(memories[first]);
      ModelAndData machine = problem.system().Build(changes);
      const Log segment = SegmentOf(log, first, first + rows);
      const Trace trace = Simulate(machine, measured, segment, *state);
      const auto residuals = Residuals(measured, segment, trace);
      for (std::size_t c = 0; c < residuals.size(); ++c)
        sums[log.train ? 0 : 1][c].Add(residuals[c].back());
      seconds.push_back(segment.time.back() - segment.time.front());
    }
  }
  if (seconds.empty()) return {};
  std::nth_element(seconds.begin(), seconds.begin() + seconds.size() / 2, seconds.end());
  PredictionError ahead{rows, seconds[seconds.size() / 2], {}, {}};
  for (const Sum& sum : sums[0]) ahead.train.push_back(sum.Root());
  for (const Sum& sum : sums[1]) ahead.validate.push_back(sum.Root());
  return ahead;
}

}  // namespace continuum
