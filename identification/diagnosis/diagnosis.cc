#include "identification/diagnosis/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>

#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/cause_pairs.h"
#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/fallback_force.h"
#include "identification/diagnosis/fold_comparison.h"
#include "identification/diagnosis/next_experiment.h"
#include "identification/diagnosis/quantisation.h"
#include "identification/problem/start_checks.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

// A copy of a log is no replicate: the noise between them is none.
void RequireOwnRecordings(const Experiment& e) {
  for (const auto& group : ReplicateGroups(e)) {
    for (std::size_t b = 1; b < group.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        const Log &first = e.logs[group[a]], &copy = e.logs[group[b]];
        if (first.measured != copy.measured) continue;
        throw Error::Input(copy.file.string(), "a recording of its own",
                           "the values of " + first.file.string() + ": a copy is no replicate");
      }
    }
  }
}

class Session {
 public:
  Session(const Experiment& experiment, const ModelSpec& system, const DiagnosisOptions& options)
      : e_(experiment), options_(options), null_(experiment, system), d_(experiment, system) {
    trials_.experiment = &e_;
    trials_.iterations = options.iterations;
  }

  Diagnosis Run() {
    const auto begin = std::chrono::steady_clock::now();
    const auto train = TrainLogs(e_);
    if (std::find(train.begin(), train.end(), true) == train.end()) {
      throw Error::Input(e_.file.string() + ": logs", "at least one with use: train", "none");
    }
    RequireOwnRecordings(e_);
    d_.noise = NoiseOf(e_);
    d_.folds = FoldsOf(e_);
    if (!d_.noise.known()) RequireFolds();  // before long work
    RequireStartModels(null_);
    FitNull();
    d_.sizes = SizesOf(null_, d_.before.fit.x);
    d_.noise.step = trials_.StepEffect(null_, d_.before);
    CandidateSearch round(trials_, {&d_.system, {}, &d_.before}, d_.noise, d_.sizes, options_);
    round.Screen();
    round.Fit();
    if (d_.noise.known()) {
      Judge(round);
      LookAtOtherPlaces(round);
      if (d_.verdict.text == "unexplained" && round.StartAnew()) Judge(round);
      LookBeyondTheList(round);
      auto pair = MayBeTwo(round) ? FindPair(trials_, round, excused_, d_.noise, d_.sizes, options_)
                                  : std::nullopt;
      d_.noise_limited = pair || beyond_ || round.BestLeaves() < CandidateSearch::kModelLimited;
      if (pair) {
        JudgePair(*pair);
      } else {
        Take(round);
      }
    } else {
      Take(round);
    }
    LookAtTheEquation();
    if (d_.noise_limited) {
      NameOnce();
      FitFinely();
      ScoreFolds();
    } else {
      CompareFolds();
      NameOnce();
    }
    BootstrapGain();
    if (d_.verdict.text == "unexplained") FallBack();
    options_.Say("next experiment");
    d_.next = ProposeNext(trials_, d_);
    d_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(d_);
  }

 private:
  // Twice where values are rounded: a model tells how they move between the steps.
  void FitNull() {
    options_.Say("null fit");
    if (d_.noise.known()) trials_.whitening = Whitening(null_, d_.noise);
    d_.before = trials_.FitNull(null_);
    if (d_.noise.known()) {
      const Quantisation rounding(null_, d_.noise, d_.before.fit.x);
      if (rounding.any()) {
        d_.noise = rounding.Corrected();
        trials_.whitening = Whitening(null_, d_.noise);
        d_.before = trials_.Fit(null_, d_.before.fit.x);
      }
    }
    trials_.Complete(null_, d_.before);
  }

  void Take(CandidateSearch& round) {
    d_.candidates = std::move(round.candidates);
    for (const CandidateResult& c : round.left_behind) {
      d_.dismissed.push_back(
          {c.hypothesis.effect, c.hypothesis.variant, c.hypothesis.where, c.explained, c.p});
    }
    for (std::string& s : round.skipped) d_.skipped.push_back(std::move(s));
  }

  void LookAtTheEquation() {
    options_.Say("missing force");
    const EquationErrors view(e_, d_.system, d_.before);
    ParallelFor(d_.candidates.size(), [&](std::size_t, std::size_t i) {
      d_.candidates[i].by_equation = view.Of(d_.candidates[i]);
    });
  }

  // No single candidate leaves noise, or only by the time step's leave; and what the best leaves is
  // not a hundred times the noise.
  bool MayBeTwo(const CandidateSearch& round) const {
    constexpr double kHopeless = 10;
    const bool more =
        d_.verdict.text == "unexplained" || (excused_ && d_.verdict.text != "adequate");
    return more && !beyond_ && round.leading() && round.smallest_p() < LikelihoodRules{}.level &&
           round.BestLeaves() < kHopeless;
  }

  // Likelihoods have judged; the folds show what that is worth.
  void ScoreFolds() {
    if (d_.folds.empty()) return;
    options_.Say("folds");
    trials_.AddFolds(null_, d_.folds, d_.before);
    for (const std::size_t i : d_.verdict.named) RecordFolds(trials_, d_, d_.candidates[i]);
    d_.ceiling_error = {d_.noise.rms, d_.noise.rms};
    d_.ceiling_by = "noise alone";
  }

  // By likelihoods, which are calibrated where noise is all that the best model leaves.
  void Judge(CandidateSearch& round) {
    options_.Say("what is left");
    const CandidateResult* const best = round.leading();
    d_.lack = best ? round.LackOf(*best) : round.LackOfBase();
    excused_ = d_.lack.smallest() < LikelihoodRules{}.lack &&
               trials_.WithinStep(best ? best->fitted : d_.before) &&
               (!best || round.GoesWithTheStep(*best));
    Decide(round);
  }

  void Decide(CandidateSearch& round) {
    const auto records = round.Records();
    SetProbabilities(round.candidates, records);
    d_.verdict = JudgeLikelihoods(records, d_.lack.smallest(), round.smallest_p(), Rules());
    const auto& named = d_.verdict.named;
    const bool coarse = excused_ || d_.noise.step > d_.noise.rms;
    if (coarse && !named.empty() && !MoreThanStep(round.candidates[named.front()].fitted))
      d_.verdict = {"adequate", {}, "no candidate does more than the time step; try a finer one"};
  }

  // Where no effect explains it at all joints together it may be at one of them.
  void LookAtOtherPlaces(CandidateSearch& round) {
    if (d_.verdict.text != "unexplained") return;
    CandidateSearch others(trials_, {&d_.system, {}, &d_.before}, d_.noise, d_.sizes, options_,
                           SearchScope::kOthers);
    others.Screen();
    others.Fit(&round);
    if (others.candidates.empty()) return;
    round.Join(std::move(others));
    Judge(round);
  }

  // A name that stands only because the list leaves its rival out is none.
  void LookBeyondTheList(CandidateSearch& round) {
    DiagnosisOptions options = options_;
    options.candidates = Unlisted(e_, options_.candidates);
    if (options.candidates.empty() || d_.verdict.text == "adequate") return;
    CandidateSearch beyond(trials_, {&d_.system, {}, &d_.before}, d_.noise, d_.sizes, options);
    beyond.Screen();
    beyond.Fit(&round);
    const bool unexplained = d_.verdict.text == "unexplained";
    const CandidateResult* const best = beyond.leading();
    const bool judged = best && best->fitted.complete;  // else plainly behind
    beyond_ = unexplained && judged && beyond.LackOf(*best).smallest() >= LikelihoodRules{}.lack;
    const std::string name = beyond_ ? best->hypothesis.NameAtPlace() : "";
    const std::size_t listed = round.candidates.size();
    round.JoinUnlisted(std::move(beyond));
    Decide(round);
    if (beyond_) d_.verdict.reason += fmt::format("; {}, which is not listed, is enough", name);
    beyond_ = beyond_ || (!unexplained && d_.verdict.text == "unexplained");
    // Only what was asked for is a candidate; of the others those stay that the verdict tells of.
    for (std::size_t& i : d_.verdict.unlisted) {
      d_.unlisted.push_back(std::move(round.candidates[i]));
      i = d_.unlisted.size() - 1;
    }
    round.candidates.erase(round.candidates.begin() + static_cast<std::ptrdiff_t>(listed),
                           round.candidates.end());
  }

  // Whether a fit takes more off the error than the time step may have put there.
  bool MoreThanStep(const Fitted& f) const {
    return Beyond(d_.before.error.train, f.error.train) > d_.noise.step;
  }

  LikelihoodRules Rules() const {
    LikelihoodRules rules;
    rules.excused = excused_;
    return rules;
  }

  static void SetProbabilities(std::vector<CandidateResult>& candidates,
                               const std::vector<LikelihoodRecord>& records) {
    const auto probability = ProbabilitiesOf(records);
    for (std::size_t i = 0; i < records.size(); ++i) candidates[i].probability = probability[i];
  }

  // Likelihoods of both together, over the model without either.
  void JudgePair(Pair& pair) {
    d_.verdict = pair.verdict;
    d_.lack = pair.lack;
    SetProbabilities(pair.round.candidates, pair.round.Records());
    for (CandidateResult& c : pair.round.candidates) c.likelihood += pair.first_likelihood;
    Take(pair.round);
    d_.pairs = std::move(pair.tried);
    d_.partner = {std::move(pair.first), std::move(pair.equivalent)};
    d_.verdict.reason =
        fmt::format("no single candidate leaves only noise, two do: {} at {} beside this; {}",
                    d_.partner->hypothesis.Name(), d_.partner->hypothesis.where, d_.verdict.reason);
    const bool one = d_.verdict.named.size() == 1 && d_.partner->equivalent.empty();
    d_.verdict.text = one ? "named" : "ambiguous";
  }

  // One effect at several places is one name: the data do not tell the places apart.
  void NameOnce() {
    auto& named = d_.verdict.named;
    if (named.size() < 2) return;
    const std::string& effect = d_.candidates[named.front()].hypothesis.effect;
    std::string places;
    for (const std::size_t i : named) {
      const Hypothesis& h = d_.candidates[i].hypothesis;
      if (h.effect != effect) return;
      places += (places.empty() ? "" : " or ") + (h.variant.empty() ? h.where : h.NameAtPlace());
    }
    if (!d_.partner) {
      d_.verdict.text = "named";
      d_.verdict.reason = d_.noise_limited
                              ? "it leaves " + LeftInWords(d_.lack.smallest(), Rules())
                              : "it passes all rules and is clearly better than every other effect";
    } else if (d_.partner->equivalent.empty()) {
      d_.verdict.text = "named";
    }
    d_.verdict.reason += "; the data do not tell " + places + " apart";
    named.resize(1);
  }

  void FitFinely() {
    for (const std::size_t i : d_.verdict.named) {
      CandidateResult& c = d_.candidates[i];
      options_.Say("at a fine step " + c.hypothesis.Name());
      trials_.FitFinely(c.ProblemOf(e_), c.fitted);
    }
  }

  // Not where forces of many more terms reach less than half of what it is asked for.
  void FallBack() {
    if (!d_.noise_limited && CeilingGain(d_) < 0.5 * continuum::Rules{}.median_gain) return;
    d_.fallback = FindFallback(trials_, d_, options_);
    if (d_.fallback && !d_.noise_limited)
      RaiseCeiling(d_, "the force of the fallback", d_.fallback->fitted.folds,
                   d_.fallback->fitted.error);
  }

  void RequireFolds() const {
    if (!d_.folds.empty()) return;
    throw Error::Input(e_.file.string() + ": folds",
                       "at least two groups of logs to leave out in turn", "one");
  }

  void CompareFolds() {
    RequireFolds();
    d_.verdict = {};
    d_.unlisted.clear();
    CompareByFolds(trials_, options_, d_);
  }

  // Of each held-out trial, replicates together: squared errors before and after. Where they are
  // too few to say how the gain varies, of the folds.
  std::vector<std::pair<double, double>> HeldOut(const CandidateResult& chosen) const {
    constexpr std::size_t kEnough = 3;
    std::map<std::string, std::pair<double, double>> trials;
    for (std::size_t l = 0; l < e_.logs.size(); ++l) {
      if (e_.logs[l].train) continue;
      std::vector<bool> one(e_.logs.size(), false);
      one[l] = true;
      const auto sum = [&](const Fitted& f) {
        return std::pow(null_.PooledRms(f.residuals, one), 2) *
               static_cast<double>(e_.logs[l].rows());
      };
      auto& [before, after] = trials[e_.logs[l].trial];
      before += sum(d_.before), after += sum(chosen.fitted);
    }
    std::vector<std::pair<double, double>> squares;
    for (const auto& [name, pair] : trials) squares.push_back(pair);
    const auto &before = d_.before.folds.error, &after = chosen.fitted.folds.error;
    if (squares.size() >= kEnough || after.size() <= squares.size() ||
        before.size() != after.size())
      return squares;
    squares.clear();
    for (std::size_t f = 0; f < after.size(); ++f)
      squares.emplace_back(before[f] * before[f], after[f] * after[f]);
    return squares;
  }

  // Trials left out in turn may all gain less than the validate logs do, or more.
  void BootstrapGain() {
    const CandidateResult* chosen = d_.chosen();
    if (!chosen) return;
    const auto squares = HeldOut(*chosen);
    if (squares.empty()) return;
    options_.Say("gain");
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
    const double before = d_.before.error.validate, after = chosen->fitted.error.validate;
    if (!(before > 0)) return;
    d_.gain_low = std::min(d_.gain_low, 1 - after / before);
    d_.gain_high = std::max(d_.gain_high, 1 - after / before);
  }

  const Experiment& e_;
  const DiagnosisOptions& options_;
  Problem null_;
  Diagnosis d_;
  CandidateFitter trials_;
  bool excused_ = false;  // what is left is significant, but within what the time step adds
  bool beyond_ = false;   // what is there is an effect that is not listed
};

}  // namespace

void DiagnosisOptions::Say(const std::string& text) const {
  StopIfRequested();
  if (progress) progress(text);
}

Diagnosis Diagnose(const Experiment& experiment, const ModelSpec& system,
                   const DiagnosisOptions& options) {
  return Session(experiment, system, options).Run();
}

}  // namespace continuum
