#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "models/spa/chain_error.h"
#include "models/spa/fold.h"
#include "models/spa/links_chart.h"
#include "models/spa/side_force.h"
#include "models/tool_main.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

const Eigen::Vector3d kOne(75e3, 0, 0), kTwo(40e3, 40e3, 0), kThree(40e3, 40e3, 40e3);
constexpr double kEvenness[] = {1, 10, 100, 1000, std::numeric_limits<double>::infinity()};

void PrintHead(const std::string& what) {
  fmt::print("\n| {} | δ | tip | force | torque |\n|---|---|---|---|---|\n", what);
}

SpaGap PrintRow(const std::string& name, const SpaFile& file, const SpaStepResponse& trial) {
  const SpaGap gap = ChainError(file, trial);
  fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", name, 100 * gap.delta, 100 * gap.tip,
             100 * gap.force, 100 * gap.torque);
  std::fflush(stdout);
  return gap;
}

void PrintSteps(const SpaFile& file) {
  PrintHead("% of range, N = 10, RK4 0.2 ms");
  for (const bool moving : {false, true}) {
    const char* const base = moving ? "moving" : "fixed";
    PrintRow(fmt::format("one chamber, 75 kPa, base {}", base), file, {kOne, moving});
    PrintRow(fmt::format("two chambers, 40 kPa, base {}", base), file, {kTwo, moving});
    PrintRow(fmt::format("three chambers, 40 kPa, base {}", base), file, {kThree, moving});
  }
}

void PrintLinks(const SpaFile& file, const std::string& plot) {
  PrintHead("two chambers, base fixed, RK4");
  LinksChart chart;
  for (const double step : {2e-4, 5e-5}) {
    for (const int links : {2, 4, 6, 8, 10, 16}) {
      if (step < 1e-4 && links < 8) continue;
      const SpaGap gap = PrintRow(fmt::format("N = {}, {:g} ms", links, 1e3 * step), file,
                                  {kTwo, false, links, step});
      chart.Add(links, step, gap);
    }
  }
  if (!plot.empty()) WriteFile(plot, chart.Svg());
}

void PrintTimeSteps(const SpaFile& file) {
  PrintHead("two chambers, base fixed, N = 10");
  for (const double step : {2e-3, 1e-3, 5e-4, 2e-4}) {
    PrintRow(fmt::format("implicitfast {:g} ms", 1e3 * step), file, {kTwo, false, 10, step, false});
  }
  for (const bool moving : {false, true}) {
    PrintRow(fmt::format("one chamber, base {}, implicitfast 2 ms", moving ? "moving" : "fixed"),
             file, {kOne, moving, 10, 2e-3, false});
  }
}

void PrintFree(const SpaFile& file) {
  PrintHead("free, two chambers, base fixed, N = 10, implicitfast 0.2 ms");
  for (const double s : kEvenness) {
    PrintRow(fmt::format("s = {:g}", s), file, {kTwo, false, 10, 2e-4, false, 1, s});
  }
  fmt::print(
      "\n| side force 10 mN, N = 10 | sag k/(F L²) | closed form | curvature at the mount | at the "
      "tip |\n|---|---|---|---|---|\n");
  for (const double s : kEvenness) {
    const auto [sag, closed_form, mount, tip] = PushAcross(file, {.evenness = s}, 0.01);
    fmt::print("| s = {:g} | {:.5f} | {:.5f} | {:.4f} | {:.4f} |\n", s, sag, closed_form, mount,
               tip);
  }
}

void PrintFold(const SpaFile& file) {
  fmt::print(
      "\n| kPa in all three chambers | straight, closed form | at rest | step from rest |\n"
      "|---|---|---|---|\n");
  const std::pair<const char*, double> placings[] = {
      {"hanging", 9.81}, {"without weight", 0}, {"standing", -9.81}};
  for (const auto& [name, along] : placings) {
    SpaOptions options = file.options;
    options.gravity = {0, 0, along};
    const Spa<double> spa(file.parameters, options);
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} |\n", name, 1e-3 * SpaStraightFold(spa),
               1e-3 * SpaLargestAtRest(spa), 1e-3 * SpaLargestStep(spa));
  }
}

int Main(int argc, char** argv) {
  CLI::App app("The soft pneumatic actuator in MuJoCo beside its analytic model, in tables");
  std::string plot;
  const std::map<std::string, std::function<void(const SpaFile&)>> tables{
      {"steps", PrintSteps},
      {"links", [&](const SpaFile& file) { PrintLinks(file, plot); }},
      {"timesteps", PrintTimeSteps},
      {"free", PrintFree},
      {"fold", PrintFold}};
  std::vector<std::string> chosen{"steps", "links", "timesteps", "free", "fold"};
  app.add_option("tables", chosen, "which, all by default")->check(CLI::IsMember(tables));
  app.add_option("--plot", plot, "SVG file of the table `links`");
  return RunTool(app, argc, argv, [&] {
    const SpaFile file = ReadSpa(CONTINUUM_SPA_FILE);
    for (const std::string& table : chosen) tables.at(table)(file);
  });
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) { return continuum::Main(argc, argv); }
