#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/load_model.h"
#include "app/log_check.h"
#include "app/models_folder.h"
#include "app/rank_job.h"
#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/diagnosis/effort.h"
#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/free_lengths.h"
#include "identification/report/apply_extension.h"
#include "identification/report/diagnosis_output.h"
#include "identification/report/parts.h"
#include "sim/experiment/registration.h"
#include "sim/film/side_by_side.h"
#include "sim/io/file.h"
#include "sim/io/interrupt.h"
#include "sim/io/json.h"
#include "sim/io/output_folder.h"
#include "sim/numerics/ranks.h"
#include "sim/replay/replay.h"
#include "sim/simulation/registration_fit.h"

namespace continuum {
namespace {

struct Options {
  std::string experiment, out, candidates, compare, effort = "normal";
  int placebos = 20;
  std::uint64_t seed = 1;
  bool video = false;
};

std::string ComparisonLine(const char* when, const std::string& verdict, double before,
                           double after) {
  return fmt::format("{:<6} {:<12} validate {:.4g} -> {:.4g}\n", when, verdict, before, after);
}

std::string OldComparison(const std::string& file, const Experiment& e) {
  if (file.empty()) return "";
  try {
    const auto old = ReadJson(file);
    const nlohmann::json channels = ChannelNames(e);
    const nlohmann::json then = old.value("channels", channels);
    if (then != channels)
      throw Error::Input(file, "a diagnosis of the channels " + channels.dump(), then.dump());
    const auto& error = old.at("error");
    return "compared with " + file + ":\n" +
           ComparisonLine("then", old.at("verdict").get<std::string>(),
                          error.at("before").at("validate").get<double>(),
                          error.at("after").at("validate").get<double>());
  } catch (const nlohmann::json::exception& e) {
    throw Error::Input(file, "a diagnosis.json", e.what());
  }
}

// An effect, or a law that the experiment writes.
void CheckCandidate(const std::string& name, const Experiment& e) {
  if (e.Written(name)) return;
  try {
    if (EffectNamed(name).text.empty()) return;
    throw Error::Input(name, "a law of the experiment by its own name", "none");
  } catch (const Error& error) {
    throw Error::Input("--candidates", error.what());
  }
}

// Up to two held-out logs, before and after.
void Film(const Experiment& e, const ModelSpec& system, const std::filesystem::path& folder) {
  FilmOptions film;
  film.progress = ShowProgress;
  std::vector<std::size_t> shown;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    if (!e.logs[l].train && shown.size() < 2) shown.push_back(l);
  }
  if (shown.empty()) shown.push_back(0);
  const Experiment extended = Experiment::Read(folder / "extended.yaml");
  const ModelSpec extended_system = ModelSpec::Load(folder / "extended.xml");
  FilmSideBySide({e, system, "before"}, {extended, extended_system, "after"}, shown,
                 folder / "extended.mp4", film);
  EndProgress();
  std::printf("video     %s\n", (folder / "extended.mp4").c_str());
}

// By the time that it used each rank would leave out other things.
void RequireNoTimeLimit(const Options& o) {
  if (RankCount() > 1 && EffortNamed(o.effort) != Effort::kThorough)
    throw Error::Input("--effort", "thorough, as ranks of mpirun share work without a time limit",
                       o.effort);
}

void RunDiagnose(const Options& o) {
  RequireNoTimeLimit(o);
  const Experiment read = Experiment::Read(o.experiment);
  const ModelSpec system = LoadModel(read.model);
  const std::string old = OldComparison(o.compare, read);
  DiagnosisOptions options;
  std::istringstream names(o.candidates);
  for (std::string name; std::getline(names, name, ',');) {
    CheckCandidate(name, read);
    options.candidates.push_back(name);
  }
  options.placebos = o.placebos;
  options.seed = o.seed;
  options.effort = EffortNamed(o.effort);
  options.progress = ShowProgress;
  CheckNames(read, system);
  std::vector<std::string> outputs{"diagnosis.json", kExtendedModel,      kExtendedExperiment,
                                   kFallbackModel,   kFallbackExperiment, "simulated/",
                                   kNextInputs,      "report.html"};
  if (o.video) outputs.push_back("extended.mp4");
  std::optional<OutputFolder> made;
  if (ThisRank() == 0) made.emplace(o.out, outputs, std::vector{read.file, read.model});
  Experiment e = Registered(read, system);
  if (e.soft > 0 && ThisRank() == 0)
    fmt::print(stderr, "warning: {}: `loss: soft_l1` is for identify; diagnose uses squares\n",
               e.file.string());
  if (ThisRank() == 0) PrintLogCheck(o.experiment, e, system);
  std::optional<GracefulEnd> graceful;
  if (RankCount() == 1) graceful.emplace();
  const Diagnosis d = DiagnoseWithLengths(e, system, options);
  if (!GoOnAlone()) return;
  ShowProgress(ProgressOf(DiagnosisStage::kFiles));
  MakeFolder(o.out);
  const ExtensionRun run = MeasureExtension(e, d, o.out);
  const auto missing = WriteDiagnosis(e, d, run, o.out);
  EndProgress();
  StopIfRequested();  // the files hold what there is
  std::fputs(Summary(e, d, run).c_str(), stdout);
  std::fputs(MissingInWords(missing).c_str(), stdout);
  if (!old.empty()) {
    std::fputs(
        (old + ComparisonLine("now", d.verdict.word(), d.before.error.validate, run.after.validate))
            .c_str(),
        stdout);
  }
  const std::filesystem::path folder = o.out;
  if (o.video && !run.extended.xml.empty()) Film(e, system, folder);
  std::printf("report    %s (%.0f s)\n", (folder / "report.html").c_str(), d.seconds);
  if (run.extended.xml.empty())
    throw Error::Job("there is no extended model: diagnosis.json says why, under 'missing'");
  if (d.interrupted) throw Error::Job("interrupted: the files hold what was found so far");
}

// The bundled example, copied to where its user may change it.
void CopyExample(const std::filesystem::path& to) {
  namespace fs = std::filesystem;
  const fs::path from = ModelsFolder() / "annelida";
  if (!fs::exists(from / "demo" / "annelida.yaml"))
    throw Error::Input(from.string(), "the bundled example", "none");
  MakeFolder(to / "demo");
  WriteFile(to / "annelida.xml", ReadFile(from / "annelida.xml"));
  for (const auto& entry : fs::directory_iterator(from / "demo")) {
    const fs::path name = entry.path().filename();
    if (name.extension() == ".csv" || name.extension() == ".yaml")
      WriteFile(to / "demo" / name, ReadFile(entry.path()));
  }
}

void RunDemo(const std::filesystem::path& out) {
  CopyExample(out / "annelida");
  Options o;
  o.experiment = (out / "annelida" / "demo" / "annelida.yaml").string();
  o.out = (out / "diagnosis").string();
  std::printf("$ continuum diagnose %s --out %s\n", o.experiment.c_str(), o.out.c_str());
  std::fflush(stdout);  // before a minute of work
  RunDiagnose(o);
  std::printf("Open the report in a browser. Change %s and diagnose again.\n",
              o.experiment.c_str());
}

struct ApplyOptions {
  std::string diagnosis, model, out;
};

void RunApply(const ApplyOptions& o) {
  RequireWritable(o.out, {o.diagnosis, o.model});
  const auto json = ReadJson(o.diagnosis);
  const auto folder = std::filesystem::absolute(ThroughLinks(o.out)).parent_path();
  const std::string xml = ApplyJson(LoadModel(o.model), json, o.diagnosis, folder);
  ModelSpec::Parse(xml, folder, o.diagnosis + " applied to " + o.model);  // says why it cannot be
  WriteFile(o.out, xml);
}

}  // namespace

void AddDiagnose(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub = app.add_subcommand(
      "diagnose", "Find what the simulation gets wrong, name the cause, extend the model");
  sub->add_option("experiment", o->experiment, "EXPERIMENT.yaml")->required();
  sub->add_option("--out", o->out,
                  "folder for diagnosis.json, extended.xml, extended.yaml, simulated/, report.html")
      ->required();
  sub->add_option("--candidates", o->candidates, "effects to try, separated by commas");
  sub->add_option("--effort", o->effort,
                  "quick (10 s on two cores), normal (60 s) or thorough (no limit)")
      ->check(CLI::IsMember({"quick", "normal", "thorough"}))
      ->capture_default_str();
  sub->add_option("--compare", o->compare, "an earlier diagnosis.json");
  sub->add_option("--placebos", o->placebos, "random forces to compare with")
      ->check(WholeNumberWithin(0, 1000))
      ->capture_default_str();
  sub->add_option("--seed", o->seed, "of the random forces")
      ->check(WholeNumberWithin(0, UINT64_MAX))
      ->capture_default_str();
  sub->add_flag("--video", o->video,
                "also extended.mp4: the model before and after, with what was measured");
  sub->footer(
      "Example:\n  continuum diagnose models/annelida/demo/annelida.yaml --out out --video");
  sub->callback([o] { RunDiagnose(*o); });
}

void AddDemo(CLI::App& app) {
  const auto out = std::make_shared<std::string>("continuum_demo");
  CLI::App* const sub =
      app.add_subcommand("demo", "Copy the bundled logs of a snake arm and diagnose them");
  sub->add_option("--out", *out, "folder for the copy, and for the diagnosis")
      ->capture_default_str();
  sub->footer("Example:\n  continuum demo");
  sub->callback([out] { RunDemo(*out); });
}

void AddApply(CLI::App& app) {
  const auto o = std::make_shared<ApplyOptions>();
  CLI::App* const sub =
      app.add_subcommand("apply", "Put the extension of a diagnosis into a model");
  sub->add_option("diagnosis", o->diagnosis, "DIAGNOSIS.json")->required();
  sub->add_option("model", o->model, "MODEL.xml")->required();
  sub->add_option("--out", o->out, "EXTENDED.xml")->required();
  sub->footer(
      "Example:\n  continuum apply out/diagnosis.json models/annelida/annelida.xml --out "
      "extended.xml");
  sub->callback([o] { RunApply(*o); });
}

}  // namespace continuum
