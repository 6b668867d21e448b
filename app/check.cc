#include "sim/check/check.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/load_model.h"
#include "binding/config.h"
#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/identify.h"

namespace continuum {
namespace {

struct Options {
  std::string file;
  bool json = false, all = false;
};

void CheckExperiment(const Options& o) {
  const Experiment e = Experiment::Read(o.file);
  const ModelSpec system = LoadModel(e.model);
  CheckNames(e, system);
  CheckParameters(e, system);
  std::vector<std::string> skipped;
  MakeCandidates(e, {&system}, {}, skipped);  // refuses places that the model has not
  auto findings = CheckLogs(e);
  const auto more = CheckAgainstModel(e, system);
  findings.insert(findings.end(), more.begin(), more.end());
  const std::string text = o.json  ? ToJson(findings).dump(2) + "\n"
                           : o.all ? FullReport(findings)
                                   : Report(findings);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

// What acts in a model; what its effects warn of goes to stderr.
void CheckModel(const Options& o) {
  if (o.json || o.all)
    throw Error::Input("--json, --all", "an experiment, as a model has no logs", o.file);
  const ModelSpec system = LoadModel(o.file);
  const mjModel& m = system.model();
  std::size_t effects = 0;
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string_view effect = EffectNameOf(m, i);
    if (effect.empty()) continue;
    ++effects;
    const char* const name = mj_id2name(&m, mjOBJ_PLUGIN, i);
    fmt::print("{} '{}'\n", PluginName(effect), name ? name : "");
  }
  fmt::print("{}: {} effect{} of continuum\n", o.file, effects, effects == 1 ? "" : "s");
}

bool IsModel(const std::filesystem::path& file) {
  return file.extension() == ".xml" || file.extension() == ".mjb";
}

}  // namespace

void AddCheck(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub =
      app.add_subcommand("check", "Look at the logs of an experiment, or the effects of a model");
  sub->add_option("file", o->file, "EXPERIMENT.yaml or MODEL.xml")->required();
  auto* const json = sub->add_flag("--json", o->json, "as JSON, every finding");
  sub->add_flag("--all", o->all, "every finding on a line of its own")->excludes(json);
  sub->footer("Example:\n  continuum check models/annelida/demo/annelida.yaml");
  sub->callback([o] { IsModel(o->file) ? CheckModel(*o) : CheckExperiment(*o); });
}

}  // namespace continuum
