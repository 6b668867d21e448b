#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/console.h"
#include "error.h"
#include "identification/fit/multi_start.h"
#include "identification/fit/multiple_shooting.h"
#include "identification/fit/start_hint.h"
#include "identification/fit/swarm_fit.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/inverse_dynamics/equation_error_fit.h"
#include "identification/inverse_dynamics/regressor.h"
#include "identification/problem/path_choice.h"
#include "identification/problem/start_checks.h"
#include "identification/report/fit_output.h"
#include "sim/check/check.h"
#include "sim/check/finding_groups.h"
#include "sim/experiment/registration.h"
#include "sim/io/file.h"
#include "sim/io/interrupt.h"
#include "sim/io/output_folder.h"
#include "sim/replay/replay.h"

namespace continuum {
namespace {

struct Options {
  std::string experiment, out, from, method = "lm", path = "auto";
  int iterations = 0;  // as the method likes
  int starts = 1;
  double cutoff = 0, differences = 0;  // 0: the usual
  std::uint64_t seed = 1;
  bool all = false, for_step = false, pieces = true;
};

// The path that was asked for, else the smooth one where it can go and gains by it.
Path Choose(const Options& o, const Problem& problem) {
  if (o.path == "stepped" || o.method == "regressor") return Path::kStepped;
  const std::string obstacle = SmoothObstacle(problem);
  if (o.path == "smooth") {
    if (obstacle.empty()) return Path::kSmooth;
    throw Error::Input("--path smooth", "a model that follows a smooth differential equation",
                       obstacle);
  }
  const std::string why = obstacle.empty() ? SmoothCost(problem) : obstacle;
  if (why.empty()) return Path::kSmooth;
  std::fprintf(stderr, "no smooth path: %s\n", why.c_str());
  return Path::kStepped;
}

// Parameters for the model's own step: a few iterations from those of the differential equation.
Problem::Vector ForStep(const Problem& problem, const Fit& fit, const std::vector<bool>& use,
                        FitOptions options) {
  Problem stepped = problem;
  stepped.Follow(Path::kStepped);
  options.iterations = 2;
  return FitParameters(stepped, fit.x, use, options).x;
}

struct IdentifyResult {
  Fit fit;
  std::optional<Problem::Vector> for_step;
  std::optional<Regression> regression;
  std::optional<ShootingSegments> pieces;
  std::optional<MultiStart> starts;
};

IdentifyResult Run(const Options& o, const Problem& problem, const Problem::Vector& start,
                   const std::vector<bool>& use) {
  const double soft = problem.experiment().soft;
  IdentifyResult all;
  if (o.method == "pso") {
    SwarmFitOptions options{.seed = o.seed, .soft = soft, .progress = ShowProgress};
    if (o.iterations > 0) options.iterations = o.iterations;
    all.fit = FitBySwarm(problem, use, options);
  } else if (o.method == "regressor") {
    all.regression = FitByRegressor(problem, use, {o.cutoff});
    all.fit.x = all.regression->x;
    all.fit.cost = 0.5 * SumOfSquares(problem.Residuals(all.fit.x, use));
    all.fit.seconds = all.regression->seconds;
    all.fit.converged = true;
    all.fit.message = "linear least squares";
  } else {
    FitOptions options{.soft = soft, .progress = ShowProgress};
    options.iterations = o.iterations > 0 ? o.iterations : 100;
    if (o.pieces && o.from.empty()) all.pieces = FitInPieces(problem, start, use, options);
    const Problem::Vector& begin = all.pieces ? all.pieces->x : start;
    if (o.starts > 1) {
      all.starts = FitFromMany(problem, begin, use, o.starts, o.seed, options);
      all.fit = all.starts->best;
    } else {
      all.fit = FitFar(problem, begin, use, options);
    }
    all.fit = FitByEquations(problem, std::move(all.fit), use, options);
    if (all.starts) all.starts->best = all.fit;
    if (all.pieces) {
      all.fit.seconds += all.pieces->seconds;
      all.fit.evaluations += all.pieces->evaluations;
    }
    if (problem.path() == Path::kSmooth && o.for_step && !StopRequested())
      all.for_step = ForStep(problem, all.fit, use, options);
  }
  auto unseen = use;
  unseen.flip();
  all.fit.x = FitStarts(problem, all.fit.x, unseen);
  return all;
}

std::string Way(const Options& o, const Problem& problem) {
  if (o.method == "regressor") return "none, the inverse model along the measured motion";
  if (problem.path() == Path::kSmooth) return "smooth, by CVODES and its sensitivities";
  const std::string why = problem.NoClosedForm();
  return why.empty() ? "stepped, by sensitivities of MuJoCo's own steps"
                     : "stepped, by differences of MuJoCo's own steps (" + why + ")";
}

std::string NearerBound(const FreeParameter& p, double value) {
  return value - p.lower < p.upper - value ? "its lower bound" : "its upper bound";
}

void PrintParameter(const FreeParameter& p, double value, const Uncertainty& u, Eigen::Index i) {
  std::string range = u.known() ? fmt::format("95 %: {:.5g} … {:.5g}", u.lower[i], u.upper[i])
                                : "interval not computed";
  if (u.at_bound[i]) range = "at " + NearerBound(p, value) + "; " + range;
  if (p.initial <= p.lower || p.initial >= p.upper)
    range += "; it starts at " + NearerBound(p, p.initial);
  const std::string unit = p.unit == "1" ? "" : " " + p.unit;
  std::printf("%-24s %.6g%s (%s)\n", p.name.c_str(), value, unit.c_str(), range.c_str());
}

// Where trials begin is found by itself; what stops at a bound is worth a line.
void PrintStartsAtBounds(const Problem& problem, const Problem::Vector& x, const Uncertainty& u) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (p.IsStart() && u.at_bound[i])
      std::printf("%s = %.4g %s is at %s: does the log begin elsewhere?\n", p.name.c_str(), x[i],
                  p.unit.c_str(), NearerBound(p, x[i]).c_str());
  }
}

void Print(const Problem& problem, const IdentifyResult& all, const Determined& determined,
           const std::string& out) {
  const Experiment& e = problem.experiment();
  const Fit& fit = all.fit;
  std::vector<ChannelScore> scores;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    for (ChannelScore& s : ScoreLog(e, e.logs[l], problem.Predict(fit.x, l)))
      scores.push_back(std::move(s));
  }
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (!problem.parameters()[i].IsStart())
      PrintParameter(problem.parameters()[i], fit.x[i], determined.uncertainty, i);
  }
  PrintStartsAtBounds(problem, fit.x, determined.uncertainty);
  const auto r = problem.Residuals(fit.x, problem.AllLogs());
  for (std::size_t l = 0; l < r.size(); ++l) {
    if (r[l].allFinite()) continue;
    std::printf("log '%s' (%s) has no error, with the fitted parameters: %s\n",
                e.logs[l].label.c_str(), e.logs[l].file.string().c_str(),
                WhyItDiverges(problem, fit.x, l).c_str());
  }
  auto validate = problem.TrainLogs();
  validate.flip();
  const SplitError error{problem.PooledRms(r, problem.TrainLogs()), problem.PooledRms(r, validate)};
  std::printf("%s%s\n", ErrorInWords(e, error).c_str(), MeanAbsoluteInWords(scores).c_str());
  if (determined.at_step)
    std::printf("as the model steps: %s\n", ErrorInWords(e, *determined.at_step).c_str());
  if (all.regression) {
    std::printf("forces by the inverse model: error %.3g %% (train) %.3g %% (validate)\n",
                all.regression->train, all.regression->validate);
  }
  if (all.pieces)
    std::printf("in pieces first: cost of the whole logs %.4g -> %.4g\n", all.pieces->before,
                all.pieces->after);
  if (fit.anew) std::printf("%s\n", kAnewInWords);
  if (all.starts) std::printf("%s\n", all.starts->InWords().c_str());
  std::printf("%d iterations, %zu simulations, %.1f s; report: %s/report.html\n", fit.iterations,
              fit.evaluations, fit.seconds, out.c_str());
}

// What the check of the logs warns of, its first lines and channels without variance in full.
void PrintCheck(const Options& o, const Experiment& e) {
  constexpr std::size_t kLines = 4;
  std::size_t more = 0, printed = 0;
  const auto findings = CheckLogs(e);
  for (const FindingGroup& g : Grouped(findings)) {
    const auto severity = g.members.front()->severity;
    if (severity == Finding::Severity::kInfo) continue;
    const bool constant = g.members.front()->what == "no_variance";
    if (severity == Finding::Severity::kWarning && printed >= kLines && !constant) {
      ++more;
      continue;
    }
    ++printed;
    std::string where = g.logs.size() > 1 && g.logs.size() == e.logs.size()
                            ? "all logs"
                            : fmt::format("{}", fmt::join(g.logs, ", "));
    for (const std::string& channel : g.channels)
      where += channel.empty() ? "" : ", column '" + channel + "'";
    if (!where.empty()) where += ": ";
    std::fprintf(stderr, "log check: %s%s\n", where.c_str(), g.text.c_str());
  }
  if (more > 0)
    std::fprintf(stderr, "log check: %zu more warnings: continuum check %s\n", more,
                 o.experiment.c_str());
}

void RunIdentify(const Options& o) {
  const Experiment read = Experiment::Read(o.experiment);
  const ModelSpec system = ModelSpec::Load(read.model);
  CheckNames(read, system);
  const OutFolder made(o.out,
                       {"fit.json", "fitted.xml", "fitted.yaml", "simulated/", "report.html"},
                       {read.file, read.model});
  const Experiment e = Registered(read, system);
  const auto use = o.all ? std::vector<bool>(e.logs.size(), true) : TrainLogs(e);
  Problem problem(e, system, {}, {}, use);
  if (problem.parameters().empty())
    throw Error::Input(o.experiment + ": parameters", "at least one that is not frozen",
                       e.parameters.empty() ? "none" : "frozen ones only");
  for (const auto& [option, given] :
       {std::pair{"--starts", o.starts > 1}, {"--from", !o.from.empty()}})
    if (given && o.method != "lm") throw Error::Input(option, "--method lm", o.method);
  RequireStartModels(problem);
  if (std::find(use.begin(), use.end(), true) == use.end()) {
    throw Error::Input(o.experiment + ": logs", "at least one with use: train (or --all)", "none");
  }
  const Problem::Vector start = o.from.empty() ? problem.Start() : ValuesIn(o.from, problem);
  problem.Follow(Choose(o, problem));
  if (o.differences > 0) {
    if (problem.path() == Path::kSmooth)
      throw Error::Input("--differences", "the stepped path (--path stepped)",
                         "the smooth one, which has none");
    problem.DifferBy(o.differences);
  }
  std::fprintf(stderr, "path: %s; %zu parameters, %zu logs\n", Way(o, problem).c_str(),
               problem.parameters().size(), e.logs.size());
  PrintCheck(o, e);
  const IdentifyResult all = Run(o, problem, start, use);
  const Determined determined = WriteFit(problem, all.fit, o.out,
                                         {o.method, all.for_step ? &*all.for_step : nullptr,
                                          all.regression ? &*all.regression : nullptr,
                                          all.starts ? &*all.starts : nullptr, ShowProgress});
  EndProgress();
  Print(problem, all, determined, o.out);
  for (const Confounding& t : determined.trade_offs) std::printf("%s\n", t.text.c_str());
  if (!determined.beyond_noise.empty()) std::printf("%s\n", determined.beyond_noise.c_str());
  StopIfRequested();  // the files hold the best so far
  if (const std::string hint = StartHint(problem, all.fit.x, use); !hint.empty())
    std::printf("%s\n", hint.c_str());
  if (!all.fit.converged) throw Error::Job("the fit did not converge: " + all.fit.message);
}

}  // namespace

void AddIdentify(CLI::App& app) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub = app.add_subcommand("identify", "Fit the parameters of an experiment");
  sub->add_option("experiment", o->experiment, "EXPERIMENT.yaml")->required();
  sub->add_option("--out", o->out,
                  "folder for fit.json, fitted.xml, fitted.yaml, simulated/, report.html")
      ->required();
  sub->add_option("--from", o->from,
                  "fit.json to start from: go on with a fit that was interrupted, or was made "
                  "with other logs");
  sub->add_option("--method", o->method,
                  "lm (Levenberg-Marquardt), pso (particle swarm, 20 x 40) or regressor (least "
                  "squares on the inverse model, where all joints are measured)")
      ->check(CLI::IsMember({"lm", "pso", "regressor"}))
      ->capture_default_str();
  sub->add_option("--path", o->path, "how logs are simulated: smooth (CVODES), stepped, or auto")
      ->check(CLI::IsMember({"auto", "smooth", "stepped"}))
      ->capture_default_str();
  sub->add_option("--differences", o->differences,
                  "stepped path: slopes over this share of a parameter's size; default: the "
                  "derivative where it has a closed form, else 0.001, which averages over stick "
                  "and slip; 1e-6: the derivative itself")
      ->check(NumberWithin(1e-9, 0.5));
  sub->add_option("--iterations", o->iterations, "at most; default: 100 (lm), 40 (pso)")
      ->check(WholeNumberWithin(1, 1000));
  sub->add_option("--starts", o->starts,
                  "lm: fit from the experiment's start and from random ones, keep the best")
      ->check(WholeNumberWithin(1, 10000))
      ->capture_default_str();
  sub->add_option("--seed", o->seed, "of the random starts and of the particle swarm")
      ->check(WholeNumberWithin(0, UINT64_MAX))
      ->capture_default_str();
  sub->add_option(
         "--cutoff", o->cutoff,
         "of the regressor's low-pass [Hz]; default: 50, at most a fifth of the rows' rate")
      ->check(NumberWithin(1e-9, 1e9));
  sub->add_flag("--all", o->all, "fit the validate logs too");
  sub->add_flag("!--whole", o->pieces,
                "begin with whole logs; else those of more than 20 s are fitted in pieces first");
  sub->add_flag("--for-step", o->for_step,
                "fit at the model's own step (the stepped path always does)");
  sub->footer("Example:\n  continuum identify models/annelida/demo/annelida.yaml --out out");
  sub->callback([o] { RunIdentify(*o); });
}

}  // namespace continuum
