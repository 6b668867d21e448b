#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>

#include "error.h"
#include "models/generator/pull.h"
#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/mjcf.h"

/// Prints how far the tips of the MJCF, pulled slowly, are from the solver's, as Markdown.
namespace continuum::twin_pivot {
namespace {

/// First and last number of cases in Tab 4.
struct Sweep {
  const char* name;
  int first, last;
};

void Print(const Robot& robot, const std::filesystem::path& cases,
           std::initializer_list<Sweep> sweeps) {
  const System mjcf = System::Parse(RobotMjcf(robot));
  for (const Sweep& sweep : sweeps) {
    double sum = 0, worst = 0, bent = 0;
    int count = 0;
    for (const Case& c : ReadCases(cases, robot)) {
      const int number = std::stoi(c.label);
      if (number < sweep.first || number > sweep.last) continue;
      if (c.load.condition != Condition::kV) continue;
      const Solution solution = Solve(robot, c.load);
      if (!solution.outcome.ok()) throw Error::Job(c.label + ": " + solution.outcome.why);
      const double off = 1e3 * (PulledTip(mjcf, c.load) - solution.tip).norm();
      sum += off, worst = std::max(worst, off), ++count;
      bent = std::max(bent, 1e3 * std::hypot(solution.tip.y(), solution.tip.z()));
    }
    fmt::print("| {} | {} | {:.0f} | {:.3f} | {:.3f} |\n", sweep.name, count, bent, sum / count,
               worst);
  }
}

void Print(const std::filesystem::path& folder) {
  fmt::print(
      "| distance of tips [mm] | cases | tip aside, largest | mean | max "
      "|\n|---|---|---|---|---|\n");
  const auto cases = folder / "cases.csv";
  Print(Robot::Read(folder / "a.yaml"), cases,
        {{"A, in plane", 1, 11}, {"A, out of plane", 12, 15}, {"A, payload 20 g", 31, 36}});
  Print(Robot::Read(folder / "b.yaml"), cases,
        {{"B, in plane", 16, 26}, {"B, out of plane", 27, 30}, {"B, payload 20 g", 37, 42}});
}

}  // namespace
}  // namespace continuum::twin_pivot

int main(int count, char** arguments) {
  try {
    if (count != 2) {
      throw continuum::Error::Input("continuum_twin_pivot_pulls", "FOLDER of a.yaml, b.yaml");
    }
    continuum::twin_pivot::Print(arguments[1]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
