#include "identification/diagnosis/fold_comparison.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "identification/candidates/random_forces.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/merged_places.h"
#include "identification/diagnosis/size_over_folds.h"
#include "identification/fit/cross_validation.h"
#include "sim/numerics/ranks.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

constexpr std::size_t kTerms = 16;  // of a force that is to reach the ceiling

double GainOver(const FoldScores& before, const FoldScores& after) {
  FoldRecord record;
  record.before = before.error, record.after = after.error;
  return Median(Gains(record));
}

class FoldComparison {
 public:
  FoldComparison(const CandidateFitter& fitter, const DiagnosisOptions& options, Diagnosis& d,
                 const std::vector<Parameter>& given)
      : fitter_(fitter), e_(*fitter.experiment), options_(options), d_(d), given_(given) {}

  // The one that fits best gets its folds whatever time is left: without them there is no verdict.
  // Where none is worth them, and noise tells that something is wrong, it stands without those of
  // the model as it is.
  void Run() {
    options_.Say(DiagnosisStage::kJudgement, "folds");
    const bool any = std::any_of(d_.candidates.begin(), d_.candidates.end(),
                                 [&](const CandidateResult& c) { return IsWorthFolds(c); });
    if (any || !Known() || HasTimeFor("the errors of groups of logs that are left out")) {
      fitter_.AddFolds(Problem(e_, d_.system, given_), d_.folds, d_.before);
      RunCandidates();
    }
    RunCeiling();
    RunPlacebos();
    Rank();
  }

 private:
  bool IsWorthFolds(const CandidateResult& c) const {
    return WorthFolds(d_.before.error.train, c.fitted.error.train, d_.criteria);
  }

  void RunCandidates() {
    std::stable_sort(d_.candidates.begin(), d_.candidates.end(), [](const auto& a, const auto& b) {
      return a.fitted.error.train < b.fitted.error.train;
    });
    for (std::size_t done = 0; done < d_.candidates.size(); ++done) {
      CandidateResult& c = d_.candidates[done];
      if (!IsWorthFolds(c)) continue;
      c.record.behind = GainOfFit(c) < d_.criteria.rival_gain * GainOfFit(d_.candidates.front());
      if (c.record.behind) continue;
      c.record.no_time = done > 0 && !HasTimeFor("folds of " + c.hypothesis.NameAtPlace());
      if (c.record.no_time) continue;
      options_.Say(DiagnosisStage::kJudgement, "folds of " + c.hypothesis.Name(), done,
                   d_.candidates.size());
      RecordFolds(fitter_, d_, c);
    }
  }

  // Where it was fitted: on logs left out it will hardly be a larger share of the best one's.
  double GainOfFit(const CandidateResult& c) const {
    return 1 - c.fitted.error.train / d_.before.error.train;
  }

  // Fits a force without a name at the null optimum (Gauss-Newton), scored like a candidate.
  FoldScores TryForce(const ForceTerms& terms, TwoErrors* error) const {
    const Problem problem(e_, d_.system, given_, terms);
    Vector x = Vector::Zero(d_.before.fit.x.size() + static_cast<Eigen::Index>(terms.count));
    x.head(d_.before.fit.x.size()) = d_.before.fit.x;
    const auto J = problem.Jacobian(x, d_.before.residuals, problem.AllLogs(),
                                    d_.before.sensitivities.value().jacobian);
    if (error) {
      auto validate = problem.TrainLogs();
      validate.flip();
      const Vector fitted =
          RefitByChords(problem, x, d_.before.residuals, J, problem.TrainLogs(), 5);
      const auto r = problem.Residuals(fitted, problem.AllLogs());
      *error = {problem.PooledRms(r, problem.TrainLogs()), problem.PooledRms(r, validate)};
    }
    return CrossValidate(problem, x, d_.before.residuals, J, d_.folds);
  }

  void RunCeiling() {
    options_.Say(DiagnosisStage::kJudgement, "ceiling");
    RaiseCeiling(d_, "the model as it is", d_.before.folds, d_.before.error);
    if (HasTimeFor("forces without a name")) {
      Raise("a smooth force without a name", RandomForce(kTerms, true, d_.sizes, options_.seed));
      if (!e_.quasi_static)  // there nothing moves
        Raise("a friction without a name", RandomFriction(kTerms, d_.sizes, options_.seed));
    }
    for (const CandidateResult& c : d_.candidates) {
      if (!c.record.after.empty())
        RaiseCeiling(d_, c.hypothesis.NameAtPlace(), c.fitted.folds, c.fitted.error);
    }
  }

  bool HasTimeFor(const std::string& what) const { return fitter_.HasTimeFor(what, d_.left_out); }

  void Raise(const std::string& by, const ForceTerms& terms) {
    TwoErrors error;
    const FoldScores scores = TryForce(terms, &error);
    RaiseCeiling(d_, by, scores, error);
  }

  // Placebos with one and with two parameters, as many as the candidates have; as long as one of
  // these passes every other rule and may still pass this one.
  void RunPlacebos() {
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}}) {
      std::vector<CandidateResult*> alike;
      for (CandidateResult& c : d_.candidates) {
        if (std::min<std::size_t>(2, c.hypothesis.extra.size()) == count) alike.push_back(&c);
      }
      std::vector<CandidateResult*> open = alike;
      std::vector<double> gains;
      const auto done = [&](const CandidateResult* c) {
        return !Failures(c->record, d_.criteria).empty() || LostTooOften(*c, gains);
      };
      const auto wanted = static_cast<std::size_t>(options_.placebos);
      std::vector<double> ahead;  // gains that are known, but not yet compared with
      for (std::size_t k = 0; k < wanted; ++k) {
        std::erase_if(open, done);
        if (open.empty() || !HasTimeFor("some of the random forces")) break;
        options_.Say(DiagnosisStage::kJudgement,
                     fmt::format("random forces, {} parameter(s)", count), k, wanted);
        if (k == ahead.size()) AddGains(count, std::min(wanted, k + RankCount()), ahead);
        gains.push_back(ahead[k]);
      }
      for (CandidateResult* const c : alike) c->record.placebo_gains = gains;
    }
  }

  // Up to some number of them, of several ranks one each: a few may be in vain.
  void AddGains(std::size_t count, std::size_t end, std::vector<double>& gains) const {
    const std::size_t known = gains.size();
    gains.resize(end);
    ShareTasks(
        end - known, [&](std::size_t i) { gains[known + i] = GainOfPlacebo(count, known + i); },
        [&](auto& archive, std::size_t i) { archive(gains[known + i]); });
  }

  double GainOfPlacebo(std::size_t count, std::size_t k) const {
    FoldRecord record;
    record.before = d_.before.folds.error;
    const std::uint64_t seed = options_.seed + 1000 * count + k;
    record.after = TryForce(RandomForce(count, k % 2 == 1, d_.sizes, seed), nullptr).error;
    return Median(Gains(record));
  }

  bool LostTooOften(const CandidateResult& c, const std::vector<double>& placebos) const {
    const double lost = static_cast<double>(placebos.size()) - Beaten(c.record, placebos);
    return lost > (1 - d_.criteria.placebo_share) * options_.placebos + 1e-9;
  }

  bool Known() const { return d_.noise.known() && d_.noise.rms > 0; }

  void Rank() {
    std::stable_sort(d_.candidates.begin(), d_.candidates.end(), [](const auto& a, const auto& b) {
      return Median(Gains(a.record)) > Median(Gains(b.record));
    });
    std::vector<FoldRecord> records;
    for (CandidateResult& c : d_.candidates) {
      c.failures = Failures(c.record, d_.criteria);
      if (Known()) c.record.over_noise = c.fitted.error.train / d_.noise.floor();
      c.record.kin = KinOf(c.hypothesis.Card());
      c.record.contains.clear();
      for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
        const CandidateResult& other = d_.candidates[i];
        if (&other != &c && Contains(fitter_, c, other)) c.record.contains.push_back(i);
      }
      records.push_back(c.record);
    }
    const ErrorLevel error{.over_noise = Known() ? d_.before.error.train / d_.noise.floor() : 0,
                           .ceiling_gain = CeilingGain(d_),
                           .over_scatter = OverScatter(d_),
                           .by_replicates = Known() && d_.noise.source == "replicates"};
    d_.verdict = JudgeFolds(records, error, d_.criteria);
    if (d_.Is(Verdict::Kind::kNamed)) CheckAgainstMissingForce();
  }

  // A name that the missing force at the measured states speaks against is none.
  void CheckAgainstMissingForce() {
    const std::size_t named = d_.verdict.named.front();
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
      const CandidateResult& c = d_.candidates[i];
      const bool rival = i != named && !Related(i, named) &&
                         GainOf(c) >= d_.criteria.rival_gain * GainOf(d_.candidates[named]) &&
                         ClearlyBetterByEquation(c, d_.candidates[named], d_.criteria);
      if (rival && (!best || c.by_equation->share > d_.candidates[*best].by_equation->share))
        best = i;
    }
    if (!best) return;
    d_.verdict.kind = Verdict::Kind::kAmbiguous;
    d_.verdict.named.push_back(*best);
    d_.verdict.reason += fmt::format(
        " on the logs left out, but {} explains the missing force at the measured states better",
        d_.candidates[*best].hypothesis.NameAtPlace());
  }

  static double GainOf(const CandidateResult& c) { return Median(Gains(c.record)); }

  // One effect, or one that can do what the other does.
  bool Related(std::size_t a, std::size_t b) const {
    const auto holds = [&](std::size_t outer, std::size_t inner) {
      const auto& contains = d_.candidates[outer].record.contains;
      return std::find(contains.begin(), contains.end(), inner) != contains.end();
    };
    return d_.candidates[a].hypothesis.effect == d_.candidates[b].hypothesis.effect ||
           d_.candidates[a].record.kin.Of(d_.candidates[b].record.kin) || holds(a, b) ||
           holds(b, a);
  }

  const CandidateFitter& fitter_;
  const Experiment& e_;
  const DiagnosisOptions& options_;
  Diagnosis& d_;
  const std::vector<Parameter>& given_;
};

}  // namespace

double OverScatter(const Diagnosis& d) {
  if (d.noise.source != "differences" || !(d.noise.rms > 0)) return 0;
  return std::max(d.before.error.train, d.before.error.validate) / d.noise.rms;
}

double CeilingGain(const Diagnosis& d) { return GainOver(d.before.folds, d.ceiling); }

void RaiseCeiling(Diagnosis& d, const std::string& by, const FoldScores& folds,
                  const TwoErrors& error) {
  if (!d.ceiling.error.empty() && GainOver(d.before.folds, folds) <= CeilingGain(d)) return;
  d.ceiling = folds, d.ceiling_error = error, d.ceiling_by = by;
}

void RecordFolds(const CandidateFitter& fitter, const Diagnosis& d, CandidateResult& c) {
  const Problem problem = ProblemOf(c, *fitter.experiment);
  if (!c.fitted.complete()) fitter.Complete(problem, c.fitted);
  fitter.AddFolds(problem, d.folds, c.fitted);
  c.record.before = d.before.folds.error;
  c.record.after = c.fitted.folds.error;
  c.record.amplitude = SizeOverFolds(c);
}

void LeaveWithoutFolds(Diagnosis& d) {
  MergePlaces(d);
  d.verdict.complete = false;
  d.verdict.reason =
      "the best candidate leaves more than noise, and all logs are of one group, so that none can "
      "be left out to try a name on: record another motion";
}

void CompareByFolds(const CandidateFitter& fitter, const DiagnosisOptions& options,
                    Diagnosis& diagnosis, const std::vector<Parameter>& given) {
  FoldComparison(fitter, options, diagnosis, given).Run();
}

}  // namespace continuum
