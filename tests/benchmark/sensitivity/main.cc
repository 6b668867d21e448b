#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "benchmark/sensitivity/cases.h"
#include "identification/problem/problem.h"

namespace continuum::speed {
namespace {

using Clock = std::chrono::steady_clock;

struct Cost {
  double wall = std::numeric_limits<double>::infinity(), processor = wall;  ///< [s]
};

// The fastest of some Jacobians.
Cost CostOf(const Problem& problem, int times) {
  const auto x = problem.Start();
  const auto use = problem.AllLogs();
  const auto r = problem.Residuals(x, use);
  Cost least;
  for (int i = 0; i < times; ++i) {
    const auto begin = Clock::now();
    const std::clock_t processor = std::clock();
    problem.Jacobian(x, r, use);
    least.wall = std::min(least.wall, std::chrono::duration<double>(Clock::now() - begin).count());
    least.processor =
        std::min(least.processor, static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
  }
  return least;
}

void Measure(const SensitivityCase& c, const std::filesystem::path& folder, int times) {
  const Experiment e = ExperimentOf(c, folder);
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  Problem differences(e, system);
  differences.DifferBy(1e-3);
  if (const std::string why = problem.NoClosedForm(); !why.empty())
    fmt::print("{}: by differences, as {}\n", c.name, why);
  const Cost exact = CostOf(problem, times), by_differences = CostOf(differences, times);
  fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.1f} |\n", c.name,
             problem.parameters().size(), exact.wall, by_differences.wall, exact.processor,
             by_differences.processor, by_differences.processor / exact.processor);
}

int Main(int argc, char** argv) {
  CLI::App app{
      "Seconds of a Jacobian over 4 s where effects act, in closed form and by differences"};
  int times = 5;
  app.add_option("--times", times, "of which the fastest counts")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const auto folder =
      std::filesystem::temp_directory_path() / fmt::format("sensitivity_speed_{}", getpid());
  fmt::print(
      "| model | parameters | closed form, wall s | differences | closed form, CPU s | "
      "differences | ratio of CPU |\n|---|---|---|---|---|---|---|\n");
  for (const SensitivityCase& c : {Arm(false), Arm(true), Annelida(), Servo()})
    Measure(c, folder, times);
  std::filesystem::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace continuum::speed

int main(int argc, char** argv) { return continuum::speed::Main(argc, argv); }
