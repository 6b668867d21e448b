#include "identification/diagnosis/diagnosis.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/cause_pairs.h"
#include "identification/diagnosis/condition_contrast.h"
#include "identification/diagnosis/confirmation.h"
#include "identification/diagnosis/effort.h"
#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/fallback_force.h"
#include "identification/diagnosis/family_starts.h"
#include "identification/diagnosis/fold_comparison.h"
#include "identification/diagnosis/forces_comparison.h"
#include "identification/diagnosis/found_law.h"
#include "identification/diagnosis/gain_interval.h"
#include "identification/diagnosis/log_requirements.h"
#include "identification/diagnosis/look_logs.h"
#include "identification/diagnosis/merged_places.h"
#include "identification/diagnosis/needless_sizes.h"
#include "identification/diagnosis/next_experiment.h"
#include "identification/diagnosis/numbers_off.h"
#include "identification/diagnosis/quantisation.h"
#include "identification/diagnosis/remaining.h"
#include "identification/diagnosis/second_by_folds.h"
#include "identification/diagnosis/unseen_effects.h"
#include "identification/fit/cross_validation.h"
#include "identification/problem/start_checks.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

class Session {
 public:
  Session(const Experiment& experiment, const ModelSpec& system, const DiagnosisOptions& options)
      : e_(experiment),
        options_(options),
        time_(options.effort, options.time_share),
        null_(experiment, system),
        d_(experiment, system) {
    fitter_.experiment = &e_;
    fitter_.iterations = options.iterations;
    fitter_.criteria = d_.criteria = options.criteria;
  }

  Diagnosis Run() {
    CheckLogs();
    FitNull();
    d_.sizes = SizesOf(null_, d_.before.fit.x);
    d_.noise.step = fitter_.StepError(null_, d_.before);
    Search();
    Begin(DiagnosisStage::kJudgement);
    Part("view by the missing force", [&] { CompareByEquation(); });
    d_.noise_limited ? JudgeByNoise() : JudgeByFolds();
    Part("a law that nobody listed", [&] { LookForALaw(); });
    WeighUnseen(d_);
    Part("interval of the gain", [&] {
      options_.Say(DiagnosisStage::kGain);
      d_.gain_interval = BootstrapGain(null_, d_, options_.seed);
    });
    FindWhatHelps();
    Describe();
    MarkAsInterrupted();
    d_.seconds = time_.seconds();
    return std::move(d_);
  }

 private:
  // One that the verdict does not depend on; whether it was made.
  bool Part(const std::string& name, const std::function<void()>& make) {
    const bool made = MakePart(name, d_.missing, make);
    StopIfRequested();
    return made;
  }

  void JudgeByNoise() {
    MergePlaces(d_);
    CompleteNamed();
    Part("sizes that are not needed", [&] { DropSizes(); });
    Part("intervals at a fine step", [&] { FitFinely(); });
    Part("lengths and masses in intervals", [&] {
      AllowInIntervals(fitter_, options_, d_);
      DoubtByNumbers(fitter_, d_);
    });
    Part("folds", [&] {
      ScoreFolds();
      ConfirmOnFolds(fitter_, d_);
    });
  }

  void JudgeByFolds() {
    if (d_.folds.empty()) return LeaveWithoutFolds(d_);
    if (!Part("comparison by folds", [&] { CompareFolds(); }))
      d_.verdict = {Verdict::Kind::kUnexplained, {}, "the folds could not be computed"};
    MergePlaces(d_);
    CompleteNamed();
    ConfirmOnValidateLogs(d_);
  }

  // From now on fits end when the time of this stage is over.
  void Begin(DiagnosisStage stage) { fitter_.until = time_.Begin(stage); }

  // The same of a part that is often in vain.
  void BeginPart(DiagnosisStage stage) {
    constexpr double kShare = 0.08;  // of all the time
    fitter_.until = time_.BeginPart(stage, kShare);
  }

  bool HasTimeFor(const std::string& what) { return fitter_.HasTimeFor(what, d_.left_out); }

  void FindWhatHelps() {
    Begin(DiagnosisStage::kFallback);
    if (d_.Is(Verdict::Kind::kUnexplained) && HasTimeFor("a force without a cause"))
      Part("fallback", [&] { FallBack(); });
    Begin(DiagnosisStage::kNextExperiment);
    if (d_.verdict.named.size() > 1 && !HasTimeFor("the next experiment")) return;
    Part("next experiment", [&] {
      options_.Say(DiagnosisStage::kNextExperiment);
      d_.next = ProposeNext(fitter_, d_);
    });
  }

  void MarkAsInterrupted() {
    d_.interrupted = EndRequested();
    if (!d_.interrupted) return;
    d_.verdict.complete = false;
    d_.verdict.reason = "interrupted, the best so far: " + d_.verdict.reason;
  }

  // What is stated beside the verdict.
  void Describe() {
    Part("parameters", [&] {
      d_.parameters_before = null_.parameters();
      const Problem last = d_.chosen() ? ProblemOf(*d_.chosen(), e_) : null_;
      d_.parameters = last.parameters();
      d_.changes = last.CommonChanges(d_.last().fit.x);
    });
    Part("what remains", [&] { SetRemaining(); });
    Part("missing force", [&] { d_.missing_force = FindMissingForce(null_, d_.before.fit.x); });
    Part("picture of the law", [&] { d_.law_picture = PictureOfLaw(e_, d_); });
    Part("contrast of the conditions", [&] {
      d_.contrast = ConditionContrast(null_, d_.before.residuals);
      for (CandidateResult& c : d_.candidates)
        c.contrast = ConditionContrast(null_, c.fitted.residuals);
    });
  }

  void SetRemaining() {
    const Problem last = d_.chosen() ? ProblemOf(*d_.chosen(), e_) : null_;
    std::string would_take = std::move(d_.remaining.would_take);
    d_.remaining = RemainingOf(last, d_.last(), d_.noise);
    if (d_.verdict.complete) return;
    if (would_take.empty()) would_take = WouldTake(d_);
    d_.remaining.would_take = std::move(would_take);
  }

  // Before long work.
  void CheckLogs() {
    RequireTrainLogs(e_);
    RequireOwnRecordings(e_);
    d_.noise = NoiseOf(e_);
    d_.folds = FoldsOf(e_);
    if (!d_.noise.known()) RequireFolds(e_, d_.folds);
    RequireStartModels(null_);
  }

  // Twice where values are rounded: a model shows how they move between the steps.
  void FitNull() {
    options_.Say(DiagnosisStage::kNullFit);
    Begin(DiagnosisStage::kNullFit);
    if (d_.noise.known()) fitter_.whitening = Whitening(null_, d_.noise);
    d_.before = fitter_.FitNull(null_);
    if (d_.noise.known()) {
      const Quantisation quantisation(null_, d_.noise, d_.before.fit.x);
      if (quantisation.any()) {
        d_.noise = quantisation.Corrected();
        fitter_.whitening = Whitening(null_, d_.noise);
        d_.before = fitter_.Fit(null_, {d_.before.fit.x});
      }
    }
    fitter_.Complete(null_, d_.before);
  }

  SearchContext Context(const DiagnosisOptions& options) const {
    return {fitter_, d_.noise, d_.sizes, options};
  }
  BaseFit Base() const { return {&d_.system, {}, &d_.before, &null_}; }

  // The force that is missing at the null fit; and with the values of the experiment, as a fit that
  // leaves much has made up for what the model lacks.
  void LookAtForces() {
    const std::vector<bool> use = LogsForALook(e_, null_.step());
    views_.emplace_back(null_, d_.before.fit.x, use);
    if (d_.before.error.train > d_.criteria.model_limited * d_.noise.floor() || !d_.noise.known())
      views_.emplace_back(null_, null_.Start(), use);
  }

  // Candidates, and where the noise is known a verdict by their likelihoods.
  void Search() {
    CandidateSearch search(Context(options_), Base());
    Begin(DiagnosisStage::kScreen);
    LookAtForces();
    search.Screen(views_);
    Begin(d_.noise.known() ? DiagnosisStage::kFits : DiagnosisStage::kOtherCandidates);
    search.Fit();
    if (!d_.noise.known()) {
      Take(search);
      return;
    }
    Judge(search);
    Begin(DiagnosisStage::kOtherCandidates);
    TryOtherPlaces(search);
    FitAnew(search);
    Begin(DiagnosisStage::kOtherCandidates);
    CompareUnlisted(search);
    Begin(DiagnosisStage::kSecondCause);
    PairsFound pairs = SecondCauses(search);
    d_.pairs = std::move(pairs.tried);
    // Where two numbers are a little off others may be too: what stands by itself is told first.
    if (pairs.best && pairs.best->first.correction == Partner::Correction::kBoth &&
        d_.Is(Verdict::Kind::kNamed))
      pairs.best.reset();
    if (!pairs.best) d_.remaining.would_take = std::move(pairs.would_take);
    if (!pairs.best && d_.Is(Verdict::Kind::kUnexplained) && d_.verdict.explained_by.empty()) {
      if (auto by_error = NameByError(search.Records(), d_.criteria)) d_.verdict = *by_error;
    }
    if (!pairs.best && d_.Is(Verdict::Kind::kUnexplained) &&
        IsSmallerThanNoise(d_, search.BestOverNoise())) {
      d_.verdict = Verdict::Adequate(
          "what shows is smaller than noise and time step, and no candidate of the list explains "
          "it");
    }
    if (AllowForNumbers(fitter_, search, pairs.best, d_)) pairs.best.reset();
    d_.noise_limited = pairs.best || !d_.Is(Verdict::Kind::kUnexplained) ||
                       !d_.verdict.explained_by.empty() ||
                       search.BestOverNoise() < d_.criteria.model_limited;
    if (pairs.best) {
      JudgePair(*pairs.best);
    } else {
      Take(search);
    }
  }

  PairsFound SecondCauses(const CandidateSearch& search) {
    const CandidateResult* const best = search.leading();
    if (!best) return {};
    const double over_noise = search.BestOverNoise();
    const bool two =
        MayBeTwo(d_.verdict, d_.lack_of_fit, search.smallest_p(), over_noise, d_.criteria);
    const bool plainer =
        !two && MayBeTwoPlainer(d_.verdict, IsRich(best->hypothesis), over_noise, d_.criteria);
    if (!(two || plainer) || !HasTimeFor("a second cause")) return {};
    std::optional<PairsFound> found;
    Part("second cause",
         [&] { found.emplace(FindPair(Context(options_), search, d_.lack_of_fit.of_step)); });
    if (!found || (plainer && !(found->best && found->best->IsPlainAndEnough()))) return {};
    return std::move(*found);
  }

  // Whether the verdict may be another one with a better fit.
  bool SomethingIsLeft(const CandidateSearch& search) const {
    if (d_.Is(Verdict::Kind::kUnexplained)) return true;
    return !d_.verdict.complete && (LeavesMuch(d_, search.leading()) ||
                                    (1 - d_.verdict.leading_share > d_.criteria.second_share &&
                                     search.BestOverNoise() > d_.criteria.near_noise));
  }

  static Dismissed::Why WhyDismissed(const CandidateResult& c) {
    return c.probes.empty() ? Dismissed::Why::kNoTimeForALook : c.why_not;
  }

  void Take(CandidateSearch& search) {
    d_.candidates = std::move(search.candidates);
    for (const CandidateResult& c : search.dismissed) {
      const Hypothesis& h = c.hypothesis;
      d_.dismissed.push_back({h.effect, h.variant, h.where, c.explained, c.p, WhyDismissed(c)});
    }
    for (std::string& s : search.skipped) d_.skipped.push_back(std::move(s));
    for (std::string& s : search.left_out) d_.left_out.push_back(std::move(s));
  }

  // That are missing at the null fit, of all train logs.
  const EquationErrors& Forces() const { return of_all_logs_ ? *of_all_logs_ : views_.front(); }

  void CompareByEquation() {
    options_.Say(DiagnosisStage::kJudgement, "missing force");
    if (LogsForALook(e_, null_.step()) != TrainLogs(e_))
      of_all_logs_.emplace(null_, d_.before.fit.x, TrainLogs(e_));
    CompareByForces(Forces(), d_.candidates);
  }

  // Likelihoods have judged; the folds show what that is worth.
  void ScoreFolds() {
    if (d_.folds.empty()) return;
    options_.Say(DiagnosisStage::kJudgement, "folds");
    fitter_.AddFolds(null_, d_.folds, d_.before);
    for (const std::size_t i : d_.verdict.named) {
      if (d_.candidates[i].fitted.complete()) RecordFolds(fitter_, d_, d_.candidates[i]);
    }
    d_.ceiling_error = {d_.noise.rms, d_.noise.rms};
    d_.ceiling_by = "noise alone";
  }

  // By likelihoods, which are calibrated where noise is the whole residual of the best model.
  void Judge(CandidateSearch& search) {
    options_.Say(DiagnosisStage::kFits, "lack of fit");
    d_.lack_of_fit = search.LackOf(search.leading());
    Decide(search);
  }

  void Decide(CandidateSearch& search) {
    const auto records = search.Records();
    SetProbabilities(search.candidates, records);
    d_.verdict =
        JudgeLikelihoods(records, d_.lack_of_fit, search.smallest_p(), search.Base(), d_.criteria);
    const auto& named = d_.verdict.named;
    const bool coarse = d_.lack_of_fit.of_step || d_.noise.step > d_.noise.rms;
    // The time step may have put there what the fit takes off.
    if (coarse && !named.empty() &&
        WithoutPart(d_.before.error.train, search.candidates[named.front()].fitted.error.train) <=
            d_.noise.step)
      d_.verdict = Verdict::Adequate("no candidate does more than the time step; try a finer one");
    if (LeavesMuch(d_, search.leading())) d_.verdict.complete = false;
  }

  // Where no effect explains it at all joints together it may be at one of them.
  void TryOtherPlaces(CandidateSearch& search) {
    if (!SomethingIsLeft(search) || !HasTimeFor("candidates at other places")) return;
    BeginPart(DiagnosisStage::kOtherCandidates);
    const auto inside = options_.Inside(DiagnosisStage::kOtherCandidates, "at other places");
    CandidateSearch others(Context(inside), Base(), SearchScope::kOthers);
    const bool fitted = Part("candidates at other places", [&] {
      others.Screen(views_);
      others.Fit(&search);
    });
    if (!fitted || others.candidates.empty()) return;
    search.Join(std::move(others));
    Judge(search);
  }

  void FitAnew(CandidateSearch& search) {
    if (!SomethingIsLeft(search) && !search.HasLostFits()) return;
    BeginPart(DiagnosisStage::kOtherCandidates);
    if (search.RefitFromExperimentStart()) Judge(search);
  }

  // A name that stands only because the list omits its rival is none.
  void CompareUnlisted(CandidateSearch& search) {
    auto options = options_.Inside(DiagnosisStage::kOtherCandidates, "not listed");
    options.candidates = Unlisted(e_, options_.candidates);
    if (options.candidates.empty() || d_.Is(Verdict::Kind::kAdequate)) return;
    if (!HasTimeFor("effects that are not listed")) return;
    CandidateSearch unlisted(Context(options), Base());
    const bool fitted = Part("effects that are not listed", [&] {
      unlisted.Screen(views_, search.leading());
      unlisted.Fit(&search);
    });
    if (!fitted) return;
    const CandidateResult* const best = unlisted.leading();
    if (best) unlisted_error_ = best->fitted.error.train;
    const bool judged = best && best->fitted.complete();  // else plainly behind
    const bool enough = d_.Is(Verdict::Kind::kUnexplained) && judged &&
                        !unlisted.TestsOf(*best).significant(d_.criteria);
    const std::string name = enough ? best->hypothesis.NameAtPlace() : "";
    const std::size_t listed = search.candidates.size();
    search.JoinUnlisted(std::move(unlisted));
    Decide(search);
    if (enough && d_.verdict.explained_by.empty()) {
      d_.verdict.reason += fmt::format("; {}, which is not listed, is enough", name);
      d_.verdict.explained_by = name;
    }
    KeepListed(search, listed);
  }

  // Only what was asked for is a candidate; of the others those stay that the verdict is about.
  void KeepListed(CandidateSearch& search, std::size_t listed) {
    for (std::size_t& i : d_.verdict.unlisted) {
      d_.unlisted.push_back(std::move(search.candidates[i]));
      i = d_.unlisted.size() - 1;
    }
    search.candidates.erase(search.candidates.begin() + static_cast<std::ptrdiff_t>(listed),
                            search.candidates.end());
  }

  void SetProbabilities(std::vector<CandidateResult>& candidates,
                        const std::vector<LikelihoodRecord>& records) const {
    const auto probability = ProbabilitiesOf(records, d_.criteria);
    for (std::size_t i = 0; i < records.size(); ++i) candidates[i].probability = probability[i];
  }

  // One that is found is judged beside the candidates, on logs left out.
  void LookForALaw() {
    if (!WantsALaw(d_, unlisted_error_) || !HasTimeFor("a law that nobody listed")) return;
    FoundLaw found = FindLaw(fitter_, Forces(), d_, options_, unlisted_error_);
    if (!found.would_take.empty()) d_.remaining.would_take = std::move(found.would_take);
    if (!found.law) return;
    TakeLaw(*std::move(found.law), d_);
    JudgeByFolds();
  }

  // Likelihoods of both together, over the model without either.
  void JudgePair(Pair& pair) {
    d_.verdict = pair.verdict;
    d_.lack_of_fit = pair.lack_of_fit;
    SetProbabilities(pair.search.candidates, pair.search.Records());
    for (CandidateResult& c : pair.search.candidates) c.likelihood += pair.first_likelihood;
    Take(pair.search);
    d_.partner = std::move(pair.first);
    d_.verdict.reason = fmt::format("no single candidate is enough, two are: {} beside this; {}",
                                    d_.partner->hypothesis.NameAtPlace(), d_.verdict.reason);
    d_.verdict.kind = IsOnePair(*d_.partner, d_.verdict.named.size()) ? Verdict::Kind::kNamed
                                                                      : Verdict::Kind::kAmbiguous;
    if (d_.partner->correction == Partner::Correction::kBoth)
      d_.verdict.reason +=
          "; both change numbers of the model or the sensors by a few per cent, which others that "
          "are off, as lengths, may do as well";
  }

  // A rival that is far behind on one of the scales has no intervals so far.
  void CompleteNamed() {
    for (const std::size_t i : d_.verdict.named) {
      CandidateResult& c = d_.candidates[i];
      if (c.fitted.complete()) continue;
      options_.Say(DiagnosisStage::kJudgement, "sensitivities of " + c.hypothesis.Name());
      try {
        fitter_.Complete(ProblemOf(c, e_), c.fitted);
      } catch (const Error&) {
        StopIfRequested();  // else it goes without
      }
    }
  }

  void DropSizes() {
    for (const std::size_t i : d_.verdict.named) {
      CandidateResult& c = d_.candidates[i];
      options_.Say(DiagnosisStage::kJudgement, "sizes of " + c.hypothesis.Name());
      DropNeedlessSizes(fitter_, c);
      if (d_.partner && i == d_.verdict.named.front())
        DropNeedlessSizes(fitter_, c, d_.partner->hypothesis);
    }
  }

  void FitFinely() {
    for (const std::size_t i : d_.verdict.named) {
      CandidateResult& c = d_.candidates[i];
      if (!c.fitted.complete()) continue;
      const bool first = i == d_.verdict.named.front();
      if (!first &&
          !HasTimeFor("the interval of " + c.hypothesis.NameAtPlace() + " at a fine step"))
        continue;
      options_.Say(DiagnosisStage::kJudgement, "at a fine step, " + c.hypothesis.Name());
      fitter_.FitFinely(ProblemOf(c, e_), c.at_quarter_x, c.fitted);
    }
  }

  void FallBack() {
    if (!WorthFallback(CeilingGain(d_), d_.noise_limited, d_.criteria)) return;
    d_.fallback = FindFallback(fitter_, d_, options_);
    if (d_.fallback && !d_.noise_limited)
      RaiseCeiling(d_, "the force of the fallback", d_.fallback->fitted.folds,
                   d_.fallback->fitted.error);
  }

  void CompareFolds() {
    d_.verdict = {};
    d_.unlisted.clear();
    CompareByFolds(fitter_, options_, d_);
    if (d_.Is(Verdict::Kind::kNamed) && !d_.verdict.complete && HasTimeFor("a second cause"))
      Part("second cause", [&] { AddSecondByFolds(Context(options_), d_); });
  }

  const Experiment& e_;
  const DiagnosisOptions& options_;
  TimeBudget time_;
  Problem null_;
  Diagnosis d_;
  CandidateFitter fitter_;
  double unlisted_error_ = std::numeric_limits<double>::infinity();
  std::vector<EquationErrors> views_;          // of the missing force, for a look
  std::optional<EquationErrors> of_all_logs_;  // where those are some
};

}  // namespace

Diagnosis Diagnose(const Experiment& experiment, const ModelSpec& system,
                   const DiagnosisOptions& options) {
  return Session(experiment, system, options).Run();
}

}  // namespace continuum
