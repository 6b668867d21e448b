#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "benchmark/diagnosis/arm.h"
#include "benchmark/diagnosis/split.h"
#include "error.h"
#include "identification/diagnosis/diagnosis.h"
#include "identification/diagnosis/effort.h"
#include "sim/experiment/registration.h"
#include "sim/simulation/registration_fit.h"

namespace continuum::speed {
namespace {

std::string Load() {
  double load[1] = {};
  return getloadavg(load, 1) == 1 ? fmt::format(", load {:.1f}", load[0]) : "";
}

// Effects that were tried, at how many places.
std::string Tried(const Diagnosis& d) {
  std::set<std::string> effects;
  for (const CandidateResult& c : d.candidates) effects.insert(c.hypothesis.effect);
  for (const Dismissed& c : d.dismissed) effects.insert(c.effect);
  return fmt::format("{} effects at {} places and choices, {} of them fitted", effects.size(),
                     d.candidates.size() + d.dismissed.size(), d.candidates.size());
}

void Measure(const std::string& name, const Experiment& e, Effort effort) {
  const ModelSpec system = ModelSpec::Load(e.model);
  fmt::print("{}: {} logs, {} states{}\n", name, e.logs.size(),
             system.model().nq + system.model().nv, Load());
  Split split;
  DiagnosisOptions options;
  options.effort = effort;
  options.progress = [&](const Progress& p) { split.Next(p.stage + ": " + p.at); };
  const Diagnosis d = Diagnose(e, system, options);
  split.Stop();
  double processor = 0;
  fmt::print("  {}\n  {:<32} {:>8} {:>8}\n", Tried(d), "", "wall s", "CPU s");
  for (const Split::Part& part : split.parts()) {
    processor += part.processor;
    if (part.wall > 0)
      fmt::print("  {:<32} {:8.2f} {:8.2f}\n", part.name, part.wall, part.processor);
  }
  fmt::print("  {:<32} {:8.2f} {:8.2f}{}\n", d.verdict.word() + " after", d.seconds, processor,
             Load());
  if (d.chosen()) fmt::print("  {}\n", d.chosen()->hypothesis.NameAtPlace());
}

int Main(int argc, char** argv) {
  CLI::App app{"Where the time of a diagnosis goes"};
  std::vector<std::string> files;
  app.add_option("experiment", files,
                 "EXPERIMENT.yaml; none: six logs of an arm of three links, all candidates, with "
                 "20 g at its tip and with nothing hidden");
  std::string effort = "thorough";
  app.add_option("--effort", effort, "quick, normal, or thorough, which leaves nothing out")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  for (const std::string& file : files) {
    const Experiment read = Experiment::Read(file);
    Measure(file, Registered(read, ModelSpec::Load(read.model)), EffortNamed(effort));
  }
  if (!files.empty()) return 0;
  const auto folder =
      std::filesystem::temp_directory_path() / ("diagnosis_speed_" + std::to_string(getpid()));
  for (const double payload : {0.02, 0.0})
    Measure(payload > 0 ? "a payload" : "nothing hidden", ArmWithPayload(folder, payload),
            EffortNamed(effort));
  std::filesystem::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace continuum::speed

int main(int argc, char** argv) { return continuum::speed::Main(argc, argv); }
