#include "identification/identify.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "identification/fit/intervals.h"
#include "identification/fit/local_search.h"
#include "identification/fit/prediction_error.h"
#include "identification/fit/start_hint.h"
#include "identification/fit/swarm_fit.h"
#include "identification/inverse_dynamics/fit_by_steps.h"
#include "identification/inverse_dynamics/regressor.h"
#include "identification/inverse_dynamics/search_fit.h"
#include "identification/inverse_dynamics/short_horizon.h"
#include "identification/problem/extended_model.h"
#include "identification/problem/fitted_values.h"
#include "identification/problem/path_choice.h"
#include "identification/problem/start_checks.h"
#include "identification/statistics/identifiability.h"
#include "identification/statistics/noise_model.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Options = IdentifyOptions;

constexpr std::size_t kRowsAhead = 10;  // of a prediction
constexpr double kBesideNull = 1e-6;    // of a parameter's scale

const char* NameOf(FitMethod method) {
  return method == FitMethod::kParticleSwarm ? "pso" : "regressor";
}

void RequireFit(const Problem& problem, const std::vector<bool>& use, const Options& o) {
  const Experiment& e = problem.experiment();
  const std::string file = e.file.string();
  if (problem.parameters().empty())
    throw Error::Input(file + ": parameters", "at least one that is not frozen",
                       e.parameters.empty() ? "none" : "frozen ones only");
  for (const auto& [option, given] :
       {std::pair{"--starts", o.starts > 1}, {"--from", !o.from.empty()}})
    if (given && o.method != FitMethod::kLevenbergMarquardt)
      throw Error::Input(option, "--method lm", NameOf(o.method));
  RequireStartModels(problem);
  if (std::find(use.begin(), use.end(), true) == use.end())
    throw Error::Input(file + ": logs", "at least one with use: train (or --all)", "none");
}

// Takes the path that was asked for, else the smooth one where it can go and gains by it. Returns
// why it does not, if so.
std::string TakePath(const Options& o, Problem& problem) {
  if (o.path == Path::kStepped || o.method == FitMethod::kInverseModel) return "";
  std::string why = SmoothObstacle(problem);
  if (o.path == Path::kSmooth && !why.empty())
    throw Error::Input("--path smooth", "a model that follows a smooth differential equation", why);
  if (!o.path && why.empty()) why = SmoothCost(problem);
  if (why.empty()) problem.Follow(Path::kSmooth);
  return why;
}

void TakeDifferences(const Options& o, Problem& problem) {
  if (o.differences == 0) return;
  if (problem.path() == Path::kSmooth)
    throw Error::Input("--differences", "the stepped path (--path stepped)",
                       "the smooth one, which has none");
  problem.DifferBy(o.differences);
}

std::string PathInWords(const Options& o, const Problem& problem) {
  if (o.method == FitMethod::kInverseModel)
    return "none, the inverse model along the measured motion";
  if (problem.path() == Path::kSmooth) return "smooth, by CVODES and its sensitivities";
  const std::string why = problem.NoClosedForm();
  return why.empty() ? "stepped, by sensitivities of MuJoCo's own steps"
                     : "stepped, by differences of MuJoCo's own steps (" + why + ")";
}

std::string HowSimulated(const Options& o, const Problem& problem, const std::string& not_smooth) {
  return (not_smooth.empty() ? "" : "no smooth path: " + not_smooth + "\n") +
         fmt::format("path: {}; {} parameters, {} logs", PathInWords(o, problem),
                     problem.parameters().size(), problem.experiment().logs.size());
}

void FitSwarm(const Options& o, const Problem& problem, const std::vector<bool>& use,
              IdentifyResult& all) {
  SwarmFitOptions options{
      .seed = o.seed, .soft = problem.experiment().soft, .progress = o.progress};
  if (const auto& file = problem.experiment().file; !file.empty()) options.swarm = ReadSwarm(file);
  if (o.iterations > 0) options.swarm.iterations = o.iterations;
  all.fit = FitBySwarm(problem, use, options);
}

void FitInverseModel(const Options& o, const Problem& problem, const std::vector<bool>& use,
                     IdentifyResult& all) {
  RegressorOptions options{.cutoff = o.cutoff, .seed = o.seed, .progress = o.progress};
  if (const auto& file = problem.experiment().file; !file.empty()) options.swarm = ReadSwarm(file);
  if (o.iterations > 0) options.swarm.iterations = o.iterations;
  all.regression = FitByRegressor(problem, use, options);
  all.fit.x = all.regression->x;
  all.fit.iterations = all.regression->iterations;
  all.fit.cost = 0.5 * SumOfSquares(problem.Residuals(all.fit.x, use));
  all.fit.seconds = all.regression->seconds;
  all.fit.converged = true;
  all.fit.message = all.regression->how;
}

FitOptions LeastSquaresOptions(const Options& o, const Problem& problem) {
  constexpr int kIterations = 100;
  return {.iterations = o.iterations > 0 ? o.iterations : kIterations,
          .soft = problem.experiment().soft,
          .progress = o.progress};
}

void FitLeastSquares(const Options& o, const Problem& problem, const Vector& start,
                     const std::vector<bool>& use, IdentifyResult& all) {
  const FitOptions options = LeastSquaresOptions(o, problem);
  const FitSearch search{o.starts, o.seed, o.segments && o.from.empty()};
  Fit by_steps;  // its effort
  by_steps.x = start;
  if (problem.path() == Path::kSmooth && o.from.empty() && HasDryFriction(problem.system().model()))
    by_steps = FitBySteps(problem, start, use, o.seed, options);
  SearchedFit found = FitBySearch(problem, by_steps.x, use, search, options);
  all.fit = std::move(found.fit);
  all.fit.evaluations += by_steps.evaluations, all.fit.seconds += by_steps.seconds;
  all.segments = std::move(found.segments), all.starts = std::move(found.starts);
  FitOverPieces(problem, use, options, all.fit);
  if (!all.starts && !all.fit.over_pieces)
    all.minima = SearchAround(problem, start, use, o.seed, options, all.fit);
}

// Parameters for the model's own step: a few iterations from those of the differential equation.
Vector FitForStep(const Problem& stepped, const Vector& x, const std::vector<bool>& use,
                  FitOptions options) {
  options.iterations = 2;
  return FitParameters(stepped, x, use, options).x;
}

std::vector<Replayed> Predicted(const Problem& problem, const Vector& x) {
  const Experiment& e = problem.experiment();
  std::vector<Replayed> logs;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    Trace trace = problem.Predict(x, l);
    auto score = ScoreLog(e, e.logs[l], trace);
    logs.push_back({std::move(trace), std::move(score)});
  }
  return logs;
}

// Computes one after the other what is stated of a fit; each may fail by itself.
class Statement {
 public:
  Statement(const Options& o, const Problem& problem, const ModelSpec& system,
            const std::vector<bool>& use, IdentifyResult& all)
      : o_(o),
        problem_(problem),
        system_(system),
        use_(use),
        all_(all),
        residuals_(ResidualsOfAll()) {}

  void Make() {
    all_.logs = Predicted(problem_, all_.fit.x);
    AddUncertainty();
    if (all_.path == Path::kSmooth) AddModelStep();
    Part("ahead", [&] { all_.ahead = PredictAhead(problem_, all_.fit.x, kRowsAhead); });
    Part("fitted_model", [&] {
      const Vector& x = all_.at_step ? all_.at_step->x : all_.fit.x;
      all_.fitted = Extend(problem_, system_, x, o_.folder, "fitted.xml");
    });
    Part("noise", [&] { AddNoise(); });
    Part("divergence", [&] { AddDivergence(); });
    AddStartHint();
  }

 private:
  std::vector<Vector> ResidualsOfAll() const {
    return problem_.Residuals(all_.fit.x, problem_.AllLogs());
  }
  bool Part(const std::string& name, const std::function<void()>& make) {
    return MakePart(name, all_.missing, make);
  }

  void AddUncertainty() {
    const Vector& x = all_.fit.x;
    const bool made = Part("intervals", [&] {
      all_.uncertainty = all_.regression ? all_.regression->uncertainty : Intervals();
    });
    if (!made) all_.uncertainty = UnknownUncertainty(problem_, x, all_.missing.back().why);
    Part("trade_offs", [&] { all_.trade_offs = ConfoundingsOf(problem_, x, all_.uncertainty); });
  }

  // Of what was fitted: whole logs, or pieces of them.
  Uncertainty Intervals() {
    const Vector& x = all_.fit.x;
    const auto pieces = all_.fit.over_pieces ? OnShortHorizons(problem_, use_) : std::nullopt;
    if (!pieces) return IntervalsOf(problem_, x, residuals_, o_.progress);
    const auto r = pieces->Residuals(x, use_);
    const Noise noise = NoiseOf(problem_.experiment());
    if (noise.rms > 0)
      all_.of_pieces = OverNoise{TypicalRms(*pieces, r, use_) / noise.rms, noise.source};
    return UncertaintyOf(*pieces, x, r, pieces->Jacobian(x, r, use_));
  }

  // What the model gives at its own step, where the fit was one of its differential equation.
  void AddModelStep() {
    Part("at_step", [&] {
      Problem stepped = problem_;
      stepped.Follow(Path::kStepped);
      AtModelStep at{problem_.system().model().opt.timestep, all_.fit.x, {}};
      if (o_.for_step && all_.method == FitMethod::kLevenbergMarquardt) {
        Part("for_step", [&] {
          StopIfRequested();
          at.x = FitForStep(stepped, at.x, use_, LeastSquaresOptions(o_, problem_));
        });
      }
      at.logs = Predicted(stepped, at.x);
      all_.at_step = std::move(at);
    });
  }

  // Intervals are those of a model that is right, at the best of its local minima.
  void AddNoise() {
    const Noise noise = NoiseOf(problem_.experiment());
    const double error = TypicalRms(problem_, residuals_, problem_.TrainLogs());
    const bool far = IsFarOver(noise, error);
    if (far || IsMoreThanNoise(problem_, all_.fit.x, residuals_, problem_.TrainLogs()))
      all_.over_noise = OverNoise{error / noise.rms, noise.source, far};
  }

  void AddDivergence() {
    all_.divergence.assign(all_.logs.size(), "");
    for (std::size_t l = 0; l < all_.logs.size(); ++l) {
      if (all_.logs[l].trace.diverged || !residuals_[l].allFinite())
        all_.divergence[l] = WhyItDiverges(problem_, all_.fit.x, l);
    }
  }

  void AddStartHint() {
    if (problem_.experiment().start != Experiment::Start::kMeasured) return;
    Part("start_hint", [&] {
      StopIfRequested();
      all_.start_hint = StartHint(problem_, all_.fit.x, use_);
    });
  }

  const Options& o_;
  const Problem& problem_;
  const ModelSpec& system_;
  const std::vector<bool>& use_;
  IdentifyResult& all_;
  std::vector<Vector> residuals_;  // [log]
};

}  // namespace

Derivatives DerivativesOf(const Experiment& e, const ModelSpec& system, const IdentifyOptions& o) {
  if (o.method != FitMethod::kLevenbergMarquardt)
    throw Error::Input("--derivatives", "--method lm", NameOf(o.method));
  const auto use = o.all_logs ? std::vector<bool>(e.logs.size(), true) : TrainLogs(e);
  Problem problem(e, system, {}, {}, use);
  RequireFit(problem, use, o);
  Vector x = o.from.empty() ? problem.Start() : FittedValues(o.from, problem);
  const std::string not_smooth = TakePath(o, problem);
  TakeDifferences(o, problem);
  Derivatives all{HowSimulated(o, problem, not_smooth), {}, {}, {}};
  for (const FreeParameter& p : problem.parameters()) all.parameters.push_back(p.name);
  for (Eigen::Index k = 0; k < x.size(); ++k)  // off every null, as a fit soon is
    x[k] += problem.StepOf(x, k, kBesideNull);
  const auto ways = problem.WaysOf(x, use);
  all.made.resize(ways.size());
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    all.logs.push_back(e.logs[l].label);
    for (std::size_t k = 0; k < ways.size(); ++k) all.made[k].push_back(ways[k][l]);
  }
  return all;
}

IdentifyResult Identify(const Experiment& e, const ModelSpec& system, const IdentifyOptions& o) {
  const auto use = o.all_logs ? std::vector<bool>(e.logs.size(), true) : TrainLogs(e);
  Problem problem(e, system, {}, {}, use);
  RequireFit(problem, use, o);
  const Vector start = o.from.empty() ? problem.Start() : FittedValues(o.from, problem);
  const std::string not_smooth = TakePath(o, problem);
  TakeDifferences(o, problem);
  if (o.accepted) o.accepted(HowSimulated(o, problem, not_smooth));

  IdentifyResult all;
  all.method = o.method, all.path = problem.path();
  all.parameters = problem.parameters(), all.channels = problem.channels();
  if (o.method == FitMethod::kParticleSwarm) {
    FitSwarm(o, problem, use, all);
  } else if (o.method == FitMethod::kInverseModel) {
    FitInverseModel(o, problem, use, all);
  } else {
    FitLeastSquares(o, problem, start, use, all);
  }
  auto unseen = use;
  unseen.flip();
  all.fit.x = FitStarts(problem, all.fit.x, unseen);
  Statement(o, problem, system, use, all).Make();
  return all;
}

void CheckParameters(const Experiment& e, const ModelSpec& system) {
  const Problem problem(e, system, {}, {}, std::vector<bool>(e.logs.size(), true));
}

}  // namespace continuum
