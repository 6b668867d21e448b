#include "identification/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "error.h"
#include "identification/parallel.h"
#include "identification/placebo.h"
#include "identification/trial.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

class Session {
 public:
  Session(const Experiment& experiment, const System& system, const DiagnosisOptions& options)
      : e_(experiment), options_(options), null_(experiment, system), d_(experiment, system) {
    trials_.experiment = &e_;
    trials_.iterations = options.iterations;
  }

  Diagnosis Run() {
    const auto begin = std::chrono::steady_clock::now();
    d_.noise = NoiseOf(e_);
    if (d_.noise.known()) trials_.whitening = Whitening(null_, d_.noise);
    d_.folds = FoldsOf(e_);
    Say("null fit");
    d_.before = trials_.Fit(null_, null_.Start());
    if (d_.noise.known()) Requantise();
    d_.sizes = SizesOf(null_, d_.before.fit.x);
    d_.noise.step = StepEffect(d_.before);
    MakeHypotheses();
    if (d_.noise.known()) {
      Screen();
      if (SomethingIsLeft()) FitCandidates();
      d_.noise_limited = BestLeaves() < kModelLimited;
    } else {
      FitCandidates();
    }
    if (d_.noise_limited) {
      CompareLikelihoods();
    } else {
      CompareFolds();
    }
    BootstrapGain();
    d_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(d_);
  }

 private:
  static constexpr double kModelLimited = 3;  // times the noise

  void Say(const std::string& text) const {
    if (StopRequested()) throw Error::Job("interrupted");
    if (options_.progress) options_.progress(text);
  }

  // How far the trajectories at h and at h/4 are apart [pooled unit].
  double StepEffect(const Fitted& fitted) const {
    std::vector<Vector> column(e_.logs.size());
    for (std::size_t l = 0; l < column.size(); ++l) {
      if (e_.logs[l].train) column[l] = fitted.step[l].col(0);
    }
    return null_.PooledRms(column, null_.TrainLogs());
  }

  // Once a model tells how the values move between the steps of a quantised channel.
  void Requantise() {
    bool any = false;
    for (std::size_t c = 0; c < e_.channels.size(); ++c) {
      if (d_.noise.channel[c].quantum == 0) continue;
      any = true;
      std::vector<std::vector<double>> values;
      for (std::size_t l = 0; l < e_.logs.size(); ++l)
        values.push_back(null_.Predict(d_.before.fit.x, l).channel[c]);
      d_.noise.channel[c] = RoundingNoise(d_.noise.channel[c], values);
    }
    if (!any) return;
    trials_.whitening = Whitening(null_, d_.noise);
    d_.before = trials_.Fit(null_, d_.before.fit.x);
  }

  void MakeHypotheses() {
    Experiment wanted = e_;
    if (!options_.candidates.empty()) {
      wanted.all_candidates = false;
      wanted.candidates.clear();
      for (const auto& name : options_.candidates) wanted.candidates.push_back({name, "", false});
    }
    for (Hypothesis& h : MakeCandidates(wanted, d_.system, d_.sizes, d_.skipped)) {
      CandidateResult c{std::move(h)};
      c.record.name = c.hypothesis.Name();
      d_.candidates.push_back(std::move(c));
    }
  }

  Problem ProblemOf(const CandidateResult& c) const {
    return Problem(e_, c.hypothesis.system, c.hypothesis.extra);
  }

  // First order: what every candidate could explain of what the null fit leaves, and whether that
  // is more than noise lets the best of so many explain.
  void Screen() {
    const Remainder left = trials_.LeftBy(d_.before);
    for (CandidateResult& c : d_.candidates) {
      Say("screen " + c.hypothesis.Name());
      try {
        probes_.push_back(trials_.Probes(c.hypothesis, ProblemOf(c), d_.before, left));
      } catch (const Error& error) {
        c.error = error.what();
        probes_.emplace_back();
      }
    }
    inflation_ = Inflation(left);
    screen_ = SignificanceOf(probes_, left.residual(), inflation_, options_.seed);
    for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
      CandidateResult& c = d_.candidates[i];
      c.explained = screen_.explained[i];
      c.p = screen_.p[i];
      if (!probes_[i].empty()) {
        const std::size_t best = screen_.best[i];
        c.start = trials_.StartFrom(c.hypothesis, d_.before, best,
                                    ExplainedBy(probes_[i][best], left.residual()));
      }
    }
  }

  // Rounding errors are neither normal nor stationary: how much more of them than of whitened noise
  // the candidates' directions take up, by draws.
  double Inflation(const Remainder& left) const {
    bool any = false;
    for (const ChannelNoise& n : d_.noise.channel) any |= Rounded(n);
    if (!any) return 1;
    std::vector<Problem::Matrix> columns;
    for (const auto& probes : probes_) {
      for (const Probe& probe : probes) columns.push_back(probe.columns);
    }
    std::vector<Trace> traces;
    for (std::size_t l = 0; l < e_.logs.size(); ++l)
      traces.push_back(null_.Predict(d_.before.fit.x, l));
    std::mt19937_64 rng(options_.seed);
    constexpr int kDraws = 40;
    double power = 0, count = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Vector z = left.Project(RoundingDraw(traces, rng)).col(0);
      for (const Problem::Matrix& c : columns) {
        for (Eigen::Index i = 0; i < c.cols(); ++i) {
          const double norm = c.col(i).squaredNorm();
          if (norm > 0) power += std::pow(c.col(i).dot(z), 2) / norm, count += 1;
        }
      }
    }
    return count > 0 ? std::max(1.0, power / count) : 1;
  }

  std::vector<Problem::Matrix> RoundingDraw(const std::vector<Trace>& traces,
                                            std::mt19937_64& rng) const {
    std::vector<Problem::Matrix> draw(e_.logs.size());
    const auto channels = null_.channels();
    for (std::size_t l = 0; l < e_.logs.size(); ++l) {
      const auto rows = static_cast<Eigen::Index>(e_.logs[l].rows());
      draw[l] = Problem::Matrix::Zero(rows * static_cast<Eigen::Index>(channels.size()), 1);
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const ChannelNoise& n = d_.noise.channel[channels[c]];
        if (!Rounded(n)) continue;
        const auto errors = RoundingErrors(n, traces[l].channel[channels[c]], rng);
        for (Eigen::Index k = 0; k < rows; ++k)
          draw[l](static_cast<Eigen::Index>(c) * rows + k, 0) = errors[k] / null_.scale(c);
      }
    }
    return draw;
  }

  // Candidates are fitted when one of them is significant, or when what is left is plainly not
  // noise.
  bool SomethingIsLeft() const {
    const bool significant =
        std::any_of(d_.candidates.begin(), d_.candidates.end(),
                    [](const auto& c) { return c.p < LikelihoodRules{}.level; });
    return significant || d_.before.cost > kModelLimited * kModelLimited * d_.before.freedom;
  }

  // Those that first order leaves far behind are not fitted: where little is to be explained it is
  // right to a few units, else wrong about sizes by factors but not by orders of magnitude.
  bool Hopeless(const CandidateResult& c) const {
    double best = 0;
    for (const CandidateResult& other : d_.candidates) best = std::max(best, other.explained);
    const double needed = std::max(std::min(best - 15, 45.0), 0.02 * best);
    return d_.noise.known() && c.error.empty() && c.explained < needed;
  }

  // The likeliest first, so that the others know what to reach.
  void FitCandidates() {
    Sort([](const auto& a, const auto& b) { return a.explained > b.explained; });
    double rival = std::numeric_limits<double>::infinity();
    for (CandidateResult& c : d_.candidates) {
      if (!c.error.empty() || Hopeless(c)) continue;
      Say("fit " + c.hypothesis.Name());
      try {
        c.fitted = FitCandidate(c, rival);
        c.fits = true;
        if (d_.noise.known()) rival = std::min(rival, c.fitted.fit.cost);
        c.likelihood = (d_.before.cost - c.fitted.cost) / inflation_;
      } catch (const Error& error) {
        c.error = error.what();
      }
    }
    Sort([](const auto& a, const auto& b) { return a.likelihood > b.likelihood; });
  }

  // From the screen's start, or the best of several after a few iterations. The larger model
  // contains the smaller: its likelihood may not be lower.
  Fitted FitCandidate(const CandidateResult& c, double rival) const {
    const Problem problem = ProblemOf(c);
    if (c.start.size()) return trials_.Fit(problem, c.start, rival);
    const Vector& known = d_.before.fit.x;
    double best_cost = std::numeric_limits<double>::infinity();
    Vector best;
    for (const auto& start : c.hypothesis.starts) {
      Vector x(known.size() + static_cast<Eigen::Index>(start.size()));
      x.head(known.size()) = known;
      for (std::size_t i = 0; i < start.size(); ++i)
        x[known.size() + static_cast<Eigen::Index>(i)] = start[i];
      if (c.hypothesis.starts.size() == 1) return trials_.Fit(problem, x);
      try {
        const Fit fit = FitParameters(problem, x, problem.TrainLogs(), {4, 1e-3});
        if (fit.cost < best_cost) best_cost = fit.cost, best = fit.x;
      } catch (const Error&) {
        continue;  // this start diverges; another may not
      }
    }
    if (best.size() == 0) throw Error::Job("the simulation diverges from every start");
    return trials_.Fit(problem, best);
  }

  template <class Before>
  void Sort(const Before& before) {
    std::vector<std::size_t> order(d_.candidates.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return before(d_.candidates[a], d_.candidates[b]);
    });
    std::vector<CandidateResult> sorted;
    std::vector<std::vector<Probe>> probes;
    for (const std::size_t i : order) {
      sorted.push_back(std::move(d_.candidates[i]));
      if (!probes_.empty()) probes.push_back(std::move(probes_[i]));
    }
    d_.candidates = std::move(sorted), probes_ = std::move(probes);
  }

  // Root of the whitened sum of squares that the best model leaves, over what noise would leave.
  double BestLeaves() const {
    const Fitted& best = Leading() ? Leading()->fitted : d_.before;
    return std::sqrt(best.cost / best.freedom);
  }
  const CandidateResult* Leading() const {
    if (d_.candidates.empty() || !d_.candidates.front().fits) return nullptr;
    return &d_.candidates.front();
  }

  // A is contained in B when B's directions span A's.
  std::vector<std::size_t> ContainedIn(std::size_t b) const {
    std::vector<std::size_t> inner;
    for (std::size_t a = 0; a < probes_.size(); ++a) {
      if (a == b || probes_[a].empty() || probes_[b].empty()) continue;
      if (probes_[a].front().columns.cols() >= probes_[b].front().columns.cols()) continue;
      const Problem::Matrix& A = probes_[a].front().columns;
      const Problem::Matrix& B = probes_[b].front().columns;
      const Problem::Matrix rest = A - B * B.completeOrthogonalDecomposition().solve(A);
      if (rest.squaredNorm() < 0.01 * A.squaredNorm()) inner.push_back(a);
    }
    return inner;
  }

  // Noise is all that the best model leaves: likelihoods are calibrated.
  void CompareLikelihoods() {
    Dismiss();
    std::vector<LikelihoodRecord> records;
    for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
      const CandidateResult& c = d_.candidates[i];
      records.push_back(
          {c.hypothesis.Name(), c.hypothesis.extra.size(), c.likelihood, ContainedIn(i)});
    }
    const auto probability = ProbabilitiesOf(records);
    for (std::size_t i = 0; i < records.size(); ++i) d_.candidates[i].probability = probability[i];
    Say("what is left");
    const CandidateResult* const best = Leading();
    d_.lack = best ? trials_.LackIn(best->hypothesis.system, best->hypothesis.extra, best->fitted,
                                    d_.sizes, inflation_, options_.seed)
                   : trials_.LackIn(d_.system, {}, d_.before, d_.sizes, inflation_, options_.seed);
    const bool numerical = WithinStep(best ? best->fitted : d_.before);
    d_.verdict = JudgeLikelihoods(records, numerical ? 1 : d_.lack.smallest(), SmallestP());
    if (numerical && d_.lack.smallest() < LikelihoodRules{}.lack)
      d_.verdict.reason += "; what is left above the noise is within what the time step adds";
    NameOnce();
    if (d_.folds.empty()) return;
    AddFolds(d_.before, null_);
    for (const std::size_t i : d_.verdict.named) Record(d_.candidates[i]);
    d_.ceiling = d_.before.folds, d_.ceiling_error = d_.before.error;
    if (d_.chosen()) d_.ceiling = d_.chosen()->fitted.folds, d_.ceiling_error = d_.after();
  }

  // Whether what a model leaves above the noise is no more than what its time step adds: then it is
  // no sign of another cause.
  bool WithinStep(const Fitted& fitted) const {
    const double left = fitted.error.train, noise = d_.noise.rms;
    const double excess = std::sqrt(std::max(0.0, left * left - noise * noise));
    return excess <= 1.25 * StepEffect(fitted);
  }

  // One effect at several places is one name: the data do not tell the places apart.
  void NameOnce() {
    auto& named = d_.verdict.named;
    if (named.size() < 2) return;
    const std::string& effect = d_.candidates[named.front()].hypothesis.effect;
    std::string places;
    for (const std::size_t i : named) {
      if (d_.candidates[i].hypothesis.effect != effect) return;
      places += (places.empty() ? "" : " or ") + d_.candidates[i].hypothesis.where;
    }
    d_.verdict.text = "named";
    d_.verdict.reason = "it leaves nothing but noise; the data do not tell " + places + " apart";
    named.resize(1);
  }

  // Of all candidates, fitted or not.
  double SmallestP() const {
    double p = 1;
    for (const double one : screen_.p) p = std::min(p, one);
    return p;
  }

  void Dismiss() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
      CandidateResult& c = d_.candidates[i];
      if (c.fits) {
        if (kept != i) {
          d_.candidates[kept] = std::move(c);
          if (!probes_.empty()) probes_[kept] = std::move(probes_[i]);
        }
        ++kept;
      } else if (!c.error.empty()) {
        d_.skipped.push_back(c.hypothesis.Name() + ": " + c.error);
      } else {
        d_.dismissed.push_back(
            {c.hypothesis.effect, c.hypothesis.variant, c.hypothesis.where, c.explained, c.p});
      }
    }
    d_.candidates.erase(d_.candidates.begin() + static_cast<std::ptrdiff_t>(kept),
                        d_.candidates.end());
    if (!probes_.empty()) probes_.resize(kept);
  }

  void AddFolds(Fitted& fitted, const Problem& problem) const {
    fitted.folds = CrossValidate(problem, fitted.fit.x, fitted.jacobian, d_.folds);
  }

  void Record(CandidateResult& c) const {
    AddFolds(c.fitted, ProblemOf(c));
    c.record.before = d_.before.folds.error;
    c.record.after = c.fitted.folds.error;
    const Eigen::Index known = d_.before.fit.x.size();
    const std::span<const double> own(c.fitted.fit.x.data() + known, c.hypothesis.extra.size());
    const std::size_t main = c.hypothesis.Main(own);
    const double null = std::isinf(c.hypothesis.null[main]) ? 0 : c.hypothesis.null[main];
    for (const Vector& x : c.fitted.folds.x)
      c.record.amplitude.push_back(x[known + static_cast<Eigen::Index>(main)] - null);
  }

  // The model leaves more than noise, or nobody knows the noise: only what holds on logs left out
  // counts.
  void CompareFolds() {
    if (d_.folds.empty()) {
      throw Error::Input(e_.file.string() + ": folds",
                         "at least two groups of logs to leave out in turn", "one");
    }
    Dismiss();
    Say("folds");
    AddFolds(d_.before, null_);
    for (CandidateResult& c : d_.candidates) {
      Say("folds of " + c.hypothesis.Name());
      Record(c);
    }
    RunCeiling();
    RunPlacebos();
    Rank();
  }

  // Fits a force without a name at the null optimum (Gauss-Newton), scored like a candidate.
  FoldScores TryForce(const ForceTerms& terms, TwoErrors* error) const {
    const Problem problem(e_, d_.system, {}, terms);
    Vector x = Vector::Zero(d_.before.fit.x.size() + static_cast<Eigen::Index>(terms.count));
    x.head(d_.before.fit.x.size()) = d_.before.fit.x;
    const auto J = problem.Jacobian(x, d_.before.residuals, problem.AllLogs(), d_.before.jacobian);
    if (error) {
      auto validate = problem.TrainLogs();
      validate.flip();
      const Vector fitted = RefitByChords(problem, x, J, problem.TrainLogs(), 5);
      const auto r = problem.Residuals(fitted, problem.AllLogs());
      *error = {problem.PooledRms(r, problem.TrainLogs()), problem.PooledRms(r, validate)};
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
      const bool needed = std::any_of(d_.candidates.begin(), d_.candidates.end(),
                                      [&](const auto& c) { return size(c) == count; });
      if (!needed) continue;
      std::vector<double> gains;
      for (int k = 0; k < options_.placebos; ++k) {
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

  bool Known() const { return d_.noise.known() && d_.noise.rms > 0; }
  double Floor() const { return std::hypot(d_.noise.rms, d_.noise.step); }

  void Rank() {
    Sort([](const auto& a, const auto& b) {
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
  Trials trials_;
  std::vector<std::vector<Probe>> probes_;  // [candidate]
  Significance screen_;
  double inflation_ = 1;  // of what rounding errors explain over whitened noise
};

}  // namespace

Diagnosis Diagnose(const Experiment& experiment, const System& system,
                   const DiagnosisOptions& options) {
  return Session(experiment, system, options).Run();
}

}  // namespace continuum
