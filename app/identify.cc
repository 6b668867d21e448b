#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/console.h"
#include "app/load_model.h"
#include "app/log_check.h"
#include "app/rank_job.h"
#include "error.h"
#include "identification/identify.h"
#include "identification/report/derivative_table.h"
#include "identification/report/fit_output.h"
#include "identification/report/fit_summary.h"
#include "identification/report/parts.h"
#include "sim/experiment/registration.h"
#include "sim/io/interrupt.h"
#include "sim/io/output_folder.h"
#include "sim/numerics/ranks.h"
#include "sim/replay/replay.h"
#include "sim/replay/replay_report.h"
#include "sim/simulation/registration_fit.h"

namespace continuum {
namespace {

struct Options {
  std::string experiment, out, from, method = "lm", path = "auto";
  bool derivatives = false;
  IdentifyOptions fit;
};

IdentifyOptions ReadOptions(const Options& o) {
  IdentifyOptions options = o.fit;
  if (o.method == "pso") options.method = FitMethod::kParticleSwarm;
  if (o.method == "regressor") options.method = FitMethod::kInverseModel;
  if (o.path == "stepped") options.path = Path::kStepped;
  if (o.path == "smooth") options.path = Path::kSmooth;
  options.from = o.from;
  options.folder = o.out;
  options.progress = ShowProgress;
  return options;
}

void ListDerivatives(const Options& o, const Experiment& read, const ModelSpec& system) {
  const Derivatives all = DerivativesOf(Registered(read, system), system, ReadOptions(o));
  EndProgress();
  std::fputs(DerivativesInWords(all).c_str(), stdout);
}

void RunIdentify(const Options& o) {
  if (!o.derivatives && o.out.empty()) throw CLI::RequiredError("--out");
  const Experiment read = Experiment::Read(o.experiment);
  const ModelSpec system = LoadModel(read.model);
  CheckNames(read, system);
  if (o.derivatives) return ListDerivatives(o, read, system);
  std::optional<OutputFolder> made;
  if (ThisRank() == 0)
    made.emplace(o.out,
                 std::vector<std::string>{"fit.json", "fitted.xml", "fitted.yaml", "simulated/",
                                          "report.html"},
                 std::vector{read.file, read.model});
  const Experiment e = Registered(read, system);
  IdentifyOptions options = ReadOptions(o);
  options.accepted = [&](const std::string& how) {
    if (ThisRank() > 0) return;
    std::fprintf(stderr, "%s\n", how.c_str());
    PrintLogCheck(o.experiment, e);
  };
  const IdentifyResult result = Identify(e, system, options);
  if (!GoOnAlone()) return;
  const auto missing = WriteFit(e, result, o.out);
  EndProgress();
  std::fputs(FitSummary(e, result, o.out).c_str(), stdout);
  std::fputs(MissingInWords(missing).c_str(), stdout);
  StopIfRequested();  // the files hold the best so far
  if (result.fitted.xml.empty())
    throw Error::Job("there is no fitted model: fit.json says why, under 'missing'");
  if (!result.fit.converged) throw Error::Job("the fit did not converge: " + result.fit.message);
}

}  // namespace

void AddIdentify(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub = app.add_subcommand("identify", "Fit the parameters of an experiment");
  sub->add_option("experiment", o->experiment, "EXPERIMENT.yaml")->required();
  sub->add_option("--out", o->out,
                  "folder for fit.json, fitted.xml, fitted.yaml, simulated/, report.html");
  sub->add_flag("--derivatives", o->derivatives,
                "fit nothing: list for each parameter how its derivative is made, and why not in "
                "closed form");
  sub->add_option("--from", o->from,
                  "fit.json to start from: go on with a fit that was interrupted, or was made "
                  "with other logs");
  sub->add_option("--method", o->method,
                  "lm (Levenberg-Marquardt), pso (particle swarm, 20 x 40, or the "
                  "experiment's key swarm) or regressor (least "
                  "squares on the inverse model, along joints or places that are measured)")
      ->check(CLI::IsMember({"lm", "pso", "regressor"}))
      ->capture_default_str();
  sub->add_option("--path", o->path, "how logs are simulated: smooth (CVODES), stepped, or auto")
      ->check(CLI::IsMember({"auto", "smooth", "stepped"}))
      ->capture_default_str();
  sub->add_option("--differences", o->fit.differences,
                  "stepped path: slopes over this share of a parameter's size; default: the "
                  "derivative where it has a closed form, else 0.001, which averages over stick "
                  "and slip; 1e-6: the derivative itself")
      ->check(NumberWithin(1e-9, 0.5));
  sub->add_option("--iterations", o->fit.iterations, "at most; default: 100 (lm), 40 (pso)")
      ->check(WholeNumberWithin(1, 1000));
  sub->add_option("--starts", o->fit.starts,
                  "lm: fit from the experiment's start and from random ones, keep the best")
      ->check(WholeNumberWithin(1, 10000))
      ->capture_default_str();
  sub->add_option("--seed", o->fit.seed, "of the random starts and of the particle swarm")
      ->check(WholeNumberWithin(0, UINT64_MAX))
      ->capture_default_str();
  sub->add_option(
         "--cutoff", o->fit.cutoff,
         "of the regressor's low-pass [Hz]; default: 50, at most a fifth of the rows' rate")
      ->check(NumberWithin(1e-9, 1e9));
  sub->add_flag("--all", o->fit.all_logs, "fit the validate logs too");
  sub->add_flag("!--whole", o->fit.segments,
                "begin with whole logs; else those of more than 20 s are fitted in segments first");
  sub->add_flag("--for-step", o->fit.for_step,
                "fit at the model's own step (the stepped path always does)");
  sub->footer("Example:\n  continuum identify models/annelida/demo/annelida.yaml --out out");
  sub->callback([o] { RunIdentify(*o); });
}

}  // namespace continuum
