#include "identification/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "error.h"
#include "identification/parallel.h"
#include "identification/placebo.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

class Session {
 public:
  Session(const Experiment& experiment, const System& system, const DiagnosisOptions& options)
      : e_(experiment), options_(options), null_(experiment, system), d_(experiment, system) {}

  Diagnosis Run() {
    const auto begin = std::chrono::steady_clock::now();
    d_.noise = NoiseOf(e_);
    d_.folds = FoldsOf(e_);
    if (d_.folds.empty()) {
      throw Error::Input(e_.file.string() + ": folds",
                         "at least two groups of logs to leave out in turn", "one");
    }
    Say("null fit");
    d_.before = FitAndValidate(null_, null_.Start(), options_.iterations);
    d_.sizes = SizesOf(null_, d_.before.fit.x);
    d_.noise.step = StepEffect();
    TryCandidates();
    RunCeiling();
    RunPlacebos();
    Rank();
    BootstrapGain();
    d_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(d_);
  }

 private:
  void Say(const std::string& text) const {
    if (options_.progress) options_.progress(text);
  }

  std::vector<bool> Validate() const {
    auto use = null_.TrainLogs();
    use.flip();
    return use;
  }

  Fitted FitAndValidate(const Problem& problem, const Vector& start, int iterations) const {
    Fitted f;
    f.fit = FitParameters(problem, start, problem.TrainLogs(), {iterations, 1e-4});
    f.residuals = problem.Residuals(f.fit.x, problem.AllLogs());
    for (std::size_t l = 0; l < e_.logs.size(); ++l) {
      if (!f.residuals[l].allFinite()) {
        throw Error::Job("the simulation of " + e_.logs[l].label +
                         " diverges with the fitted parameters");
      }
    }
    f.jacobian = problem.Jacobian(f.fit.x, f.residuals, problem.AllLogs());
    auto r = f.residuals;
    auto J = f.jacobian;
    for (std::size_t l = 0; l < r.size(); ++l) {
      if (!e_.logs[l].train) J[l].resize(0, 0);
    }
    f.uncertainty = UncertaintyOf(problem, f.fit.x, r, J);
    f.error = {problem.PooledRms(f.residuals, problem.TrainLogs()),
               problem.PooledRms(f.residuals, Validate())};
    f.folds = CrossValidate(problem, f.fit.x, f.jacobian, d_.folds);
    return f;
  }

  // The best of several starts after a few iterations, fitted to the end. The larger model contains
  // the smaller: its likelihood may not be lower.
  Fitted FitCandidate(const Hypothesis& h, const Problem& problem) const {
    const Vector& known = d_.before.fit.x;
    double best_cost = std::numeric_limits<double>::infinity();
    Vector best;
    for (const auto& start : h.starts) {
      Vector x(known.size() + static_cast<Eigen::Index>(start.size()));
      x.head(known.size()) = known;
      for (std::size_t i = 0; i < start.size(); ++i)
        x[known.size() + static_cast<Eigen::Index>(i)] = start[i];
      if (h.starts.size() == 1) return FitAndValidate(problem, x, options_.iterations);
      try {
        const Fit fit = FitParameters(problem, x, problem.TrainLogs(), {4, 1e-3});
        if (fit.cost < best_cost) best_cost = fit.cost, best = fit.x;
      } catch (const Error&) {
        continue;  // this start diverges; another may not
      }
    }
    if (best.size() == 0) throw Error::Job("the simulation diverges from every start");
    return FitAndValidate(problem, best, options_.iterations);
  }

  // How far the trajectories at h and at h/4 are apart: a numerical error that no cause explains.
  double StepEffect() const {
    const Experiment fine = WithStep(e_, d_.system.model().opt.timestep / 4);
    auto r = Problem(fine, d_.system).Residuals(d_.before.fit.x, null_.TrainLogs());
    for (std::size_t l = 0; l < r.size(); ++l) r[l] -= d_.before.residuals[l].head(r[l].size());
    const double step = null_.PooledRms(r, null_.TrainLogs());
    return std::isfinite(step) ? step : 0;
  }

  void TryCandidates() {
    Experiment wanted = e_;
    if (!options_.candidates.empty()) {
      wanted.all_candidates = false;
      wanted.candidates.clear();
      for (const auto& name : options_.candidates) wanted.candidates.push_back({name, "", false});
    }
    auto hypotheses = MakeCandidates(wanted, d_.system, d_.sizes, d_.skipped);
    for (Hypothesis& h : hypotheses) {
      if (StopRequested()) throw Error::Job("interrupted");
      Say("candidate " + h.Name());
      CandidateResult c{std::move(h), {}, {}, {}, ""};
      c.record.name = c.hypothesis.Name();
      try {
        const Problem problem(e_, c.hypothesis.system, c.hypothesis.extra);
        c.fitted = FitCandidate(c.hypothesis, problem);
        c.record.before = d_.before.folds.error;
        c.record.after = c.fitted.folds.error;
        const Eigen::Index known = d_.before.fit.x.size();
        const std::span<const double> own(c.fitted.fit.x.data() + known, c.hypothesis.extra.size());
        const std::size_t main = c.hypothesis.Main(own);
        for (const Vector& x : c.fitted.folds.x) {
          c.record.amplitude.push_back(x[known + static_cast<Eigen::Index>(main)] -
                                       c.hypothesis.NullOf(main));
        }
      } catch (const Error& error) {
        c.error = error.what();
      }
      d_.candidates.push_back(std::move(c));
    }
  }

  // Fits a force without a name at the null optimum (Gauss-Newton), scored like a candidate.
  FoldScores TryForce(const ForceTerms& terms, TwoErrors* error) const {
    const Problem problem(e_, d_.system, {}, terms);
    Vector x = Vector::Zero(d_.before.fit.x.size() + static_cast<Eigen::Index>(terms.count));
    x.head(d_.before.fit.x.size()) = d_.before.fit.x;
    const auto J = problem.Jacobian(x, d_.before.residuals, problem.AllLogs(), d_.before.jacobian);
    if (error) {
      const Vector fitted = RefitByChords(problem, x, J, problem.TrainLogs(), 5);
      const auto r = problem.Residuals(fitted, problem.AllLogs());
      *error = {problem.PooledRms(r, problem.TrainLogs()), problem.PooledRms(r, Validate())};
    }
    return CrossValidate(problem, x, J, d_.folds);
  }

  void RunCeiling() {
    Say("ceiling");
    d_.ceiling = TryForce(RandomForce(16, true, d_.sizes, options_.seed), &d_.ceiling_error);
  }

  // Placebos with one and with two parameters, as many as the candidates have.
  void RunPlacebos() {
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}}) {
      const auto size = [](const CandidateResult& c) {
        return std::min<std::size_t>(2, c.hypothesis.extra.size());
      };
      const bool needed =
          std::any_of(d_.candidates.begin(), d_.candidates.end(),
                      [&](const auto& c) { return c.error.empty() && size(c) == count; });
      if (!needed) continue;
      std::vector<double> gains;
      for (int k = 0; k < options_.placebos; ++k) {
        if (StopRequested()) throw Error::Job("interrupted");
        Say(fmt::format("random force {} of {} with {} parameter(s)", k + 1, options_.placebos,
                        count));
        FoldRecord record;
        record.before = d_.before.folds.error;
        record.after =
            TryForce(RandomForce(count, k % 2 == 1, d_.sizes,
                                 options_.seed + 1000 * count + static_cast<unsigned>(k)),
                     nullptr)
                .error;
        gains.push_back(Median(Gains(record)));
      }
      for (CandidateResult& c : d_.candidates) {
        if (size(c) == count) c.record.placebo_gains = gains;
      }
    }
  }

  bool Known() const { return d_.noise.source != "differences" && d_.noise.rms > 0; }
  double Floor() const { return std::hypot(d_.noise.rms, d_.noise.step); }

  void Rank() {
    std::erase_if(d_.candidates, [&](const CandidateResult& c) {
      if (!c.error.empty()) d_.skipped.push_back(c.hypothesis.Name() + ": " + c.error);
      return !c.error.empty();
    });
    std::stable_sort(d_.candidates.begin(), d_.candidates.end(), [](const auto& a, const auto& b) {
      return Median(Gains(a.record)) > Median(Gains(b.record));
    });
    std::vector<FoldRecord> records;
    for (CandidateResult& c : d_.candidates) {
      c.failures = Failures(c.record);
      if (Known()) c.record.remaining = c.fitted.error.train / Floor();
      records.push_back(c.record);
    }
    FoldRecord ceiling;
    ceiling.before = d_.before.folds.error;
    ceiling.after = d_.ceiling.error;
    const double over = Known() ? d_.before.error.train / Floor() : 0;
    Rules rules;
    // Replicates tell the noise whatever the model: then nothing above it may remain unexplained.
    if (d_.noise.source == "replicates") rules.noise_limited = kInfinity;
    d_.verdict = Judge(records, over, Median(Gains(ceiling)), rules);
  }

  // Resamples whole trials of the held-out logs.
  void BootstrapGain() {
    const CandidateResult* chosen = d_.chosen();
    if (!chosen) return;
    std::vector<std::pair<double, double>>
        squares;  // per validation log, over its rows: before, after
    for (std::size_t l = 0; l < e_.logs.size(); ++l) {
      if (e_.logs[l].train) continue;
      std::vector<bool> one(e_.logs.size(), false);
      one[l] = true;
      const auto sum = [&](const Fitted& f) {
        return std::pow(null_.PooledRms(f.residuals, one), 2) *
               static_cast<double>(e_.logs[l].rows());
      };
      squares.emplace_back(sum(d_.before), sum(chosen->fitted));
    }
    if (squares.empty()) return;
    std::mt19937_64 rng(options_.seed);
    std::vector<double> gains;
    for (int k = 0; k < 2000; ++k) {
      double before = 0, after = 0;
      for (std::size_t i = 0; i < squares.size(); ++i) {
        const auto& s = squares[rng() % squares.size()];
        before += s.first, after += s.second;
      }
      gains.push_back(before > 0 ? 1 - std::sqrt(after / before) : 0);
    }
    std::sort(gains.begin(), gains.end());
    d_.gain_low = gains[gains.size() * 25 / 1000];
    d_.gain_high = gains[gains.size() * 975 / 1000];
  }

  const Experiment& e_;
  const DiagnosisOptions& options_;
  Problem null_;
  Diagnosis d_;
};

}  // namespace

Diagnosis Diagnose(const Experiment& experiment, const System& system,
                   const DiagnosisOptions& options) {
  return Session(experiment, system, options).Run();
}

}  // namespace continuum
