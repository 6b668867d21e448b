#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "models/twin_pivot/cases.h"

namespace continuum::twin_pivot {
namespace {

const std::string kFolder = CONTINUUM_SOURCE "/models/twin_pivot/";

// Every row of the input once per iteration, each from straight; time per solve in the counters.
void SolveFrom(benchmark::State& state, const std::string& file, const std::string& input,
               Condition least, Condition most) {
  const Robot robot = Robot::Read(kFolder + file);
  std::vector<Load> loads;
  for (Case& row : ReadCases(kFolder + input, robot)) {
    if (row.load.condition < least || row.load.condition > most) continue;
    if (row.reference >= 0) row.load.reference = Solve(robot, loads[row.reference]).length;
    loads.push_back(std::move(row.load));
  }
  int solved = 0;
  int iterations = 0;
  for (auto unused : state) {
    for (const Load& load : loads) {
      const Solution solution = Solve(robot, load);
      if (!solution.outcome.ok()) state.SkipWithError(solution.outcome.why.c_str());
      ++solved;
      iterations += solution.outcome.iterations;
    }
  }
  using Counter = benchmark::Counter;
  state.counters["per_solve"] = Counter(solved, Counter::kIsRate | Counter::kInvert);
  state.counters["iterations"] = static_cast<double>(iterations) / solved;
}

// The paper's program: 1.72 s and 8 iterations per solve.
BENCHMARK_CAPTURE(SolveFrom, six_discs_without_friction, "a.yaml", "cases.csv", Condition::kI,
                  Condition::kI);
BENCHMARK_CAPTURE(SolveFrom, six_discs_full, "a.yaml", "cases.csv", Condition::kV, Condition::kV);
BENCHMARK_CAPTURE(SolveFrom, twelve_discs_full, "b.yaml", "cases.csv", Condition::kV,
                  Condition::kV);
BENCHMARK_CAPTURE(SolveFrom, two_sections_trajectory, "c.yaml", "trajectory.csv", Condition::kV,
                  Condition::kV);

}  // namespace
}  // namespace continuum::twin_pivot
