#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "error.h"
#include "models/mjcf/slow_pull.h"
#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/mjcf.h"

/// Prints how far the tips of the MJCF, pulled slowly, are from the solver's, as Markdown.
namespace continuum::twin_pivot {
namespace {

/// Cases under condition V that are one row of the table: numbers first to last of Tab 4.
struct Sweep {
  const char* name;
  int first, last;

  bool Has(const Case& c) const {
    const int number = std::stoi(c.label);
    return number >= first && number <= last && c.load.condition == Condition::kV;
  }
};

/// Every tenth point of a trajectory, each pulled from straight.
struct Loop {
  const char* name;

  bool Has(const Case& c) const { return std::stoi(c.label.substr(1)) % 10 == 0; }
};

/// All of a table.
struct All {
  const char* name;

  static bool Has(const Case& /*c*/) { return true; }
};

template <class Choice>
void Print(const Robot& robot, const ModelSpec& mjcf, const std::vector<Case>& cases,
           const Choice& choice) {
  double sum = 0, worst = 0, bent = 0;
  int count = 0;
  for (const Case& c : cases) {
    if (!choice.Has(c)) continue;
    const Solution solution = Solve(robot, c.load);
    if (!solution.outcome.ok()) throw Error::Job(c.label + ": " + solution.outcome.why);
    const double off = 1e3 * (PulledTip(mjcf, c.load) - solution.tip).norm();
    sum += off, worst = std::max(worst, off), ++count;
    bent = std::max(bent, 1e3 * std::hypot(solution.tip.y(), solution.tip.z()));
  }
  fmt::print("| {} | {} | {:.0f} | {:.3f} | {:.3f} |\n", choice.name, count, bent, sum / count,
             worst);
}

template <class Choice>
void Print(const std::filesystem::path& file, const std::filesystem::path& input,
           std::initializer_list<Choice> choices) {
  const Robot robot = Robot::Read(file);
  const ModelSpec mjcf = ModelSpec::Parse(RobotMjcf(robot));
  const auto cases = ReadCases(input, robot);
  for (const Choice& choice : choices) Print(robot, mjcf, cases, choice);
}

void Print(const std::filesystem::path& folder) {
  fmt::print(
      "| distance of tips [mm] | cases | tip aside, largest | mean | max "
      "|\n|---|---|---|---|---|\n");
  const auto cases = folder / "cases.csv";
  Print<Sweep>(folder / "a.yaml", cases,
               {{"A, in plane", 1, 11}, {"A, out of plane", 12, 15}, {"A, payload 20 g", 31, 36}});
  Print<Sweep>(folder / "b.yaml", cases,
               {{"B, in plane", 16, 26}, {"B, out of plane", 27, 30}, {"B, payload 20 g", 37, 42}});
  Print<Loop>(folder / "c.yaml", folder / "trajectory.csv", {{"C, loop"}});
  Print<All>(folder / "c360.yaml", folder / "hanging.csv", {{"360 mm, hanging"}});
}

}  // namespace
}  // namespace continuum::twin_pivot

int main(int count, char** arguments) {
  try {
    if (count != 2) {
      throw continuum::Error::Input("continuum_twin_pivot_pulls", "FOLDER of the robots' files");
    }
    continuum::twin_pivot::Print(arguments[1]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
