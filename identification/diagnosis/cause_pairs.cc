#include "identification/diagnosis/cause_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "error.h"
#include "identification/diagnosis/correction.h"
#include "identification/diagnosis/family_starts.h"
#include "identification/diagnosis/first_causes.h"
#include "identification/diagnosis/lengths_and_masses.h"
#include "identification/diagnosis/look_logs.h"
#include "identification/diagnosis/names_of_a_set.h"
#include "identification/diagnosis/pair_fit.h"
#include "identification/diagnosis/search_bytes.h"
#include "sim/numerics/ranks.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

constexpr std::size_t kSeconds = 6;  // that are fitted beside one first cause

std::string Key(const Hypothesis& h) { return h.Name() + " at " + h.where; }

// A first cause, and the search for a second beside it.
struct Beside {
  const CandidateResult* first;
  CandidateSearch search;
};

class PairSearch {
 public:
  PairSearch(const SearchContext& context, const CandidateSearch& single, bool of_step)
      : context_(context), criteria_(context.fitter.criteria), single_(single), of_step_(of_step) {}

  PairsFound Run() {
    for (const CandidateResult* const c : FirstCauses(single_.candidates, criteria_)) {
      if (const CandidateResult* const complete = Completed(*c)) Await(*complete);
    }
    while (!waiting_.empty() && static_cast<double>(bases_) < criteria_.pair_bases &&
           !context_.fitter.TimeIsOver()) {
      const CandidateResult* const base = waiting_.front();
      waiting_.pop_front();
      Extend(*base);
    }
    const auto pairs = All();
    PairsFound found;
    found.tried = List(pairs);
    if (!pairs.empty()) TakeBest(pairs, found);
    return found;
  }

 private:
  // With sensitivities; null where it diverges next to its fit.
  const CandidateResult* Completed(const CandidateResult& c) {
    if (c.fitted.complete()) return &c;
    try {
      CandidateResult& own = alone_.emplace_back(c);
      context_.fitter.Complete(ProblemOf(c, *context_.fitter.experiment), own.fitted);
      own.likelihood = single_.Likelihood(own.fitted);
      return &own;
    } catch (const Error&) {
      alone_.pop_back();
      return nullptr;
    }
  }

  void Await(const CandidateResult& c, bool next = false) {
    if (known_.insert(Key(c.hypothesis)).second)
      waiting_.insert(next ? waiting_.begin() : waiting_.end(), &c);
  }

  // The best second cause beside a first; it is the next first.
  void Extend(const CandidateResult& first) {
    const auto inside = context_.options.Inside(DiagnosisStage::kSecondCause,
                                                "beside " + Key(first.hypothesis), bases_);
    CandidateSearch search = ScreenBeside({context_.fitter, context_.noise, context_.sizes, inside},
                                          first, single_.HopelessBeside(first));
    if (!WorthPartner(search.smallest_p(), search.ExplainableShare(), of_step_, criteria_)) return;
    search.Fit(nullptr, kSeconds);
    search.CountAs(single_);
    ++bases_;
    if (!search.leading()) return;
    const std::string partner = Key(search.leading()->hypothesis);
    tried_.push_back({&first, std::move(search)});
    Vary(first, *tried_.back().search.leading());
    if (const CandidateResult* const next = Alone(partner)) Await(*next, true);
  }

  // The same second cause beside others that explain nearly as much as the first one by themselves:
  // which of them it is shows only beside it. Several ranks fit one each.
  void Vary(const CandidateResult& first, const CandidateResult& second) {
    constexpr std::size_t kMost = 3;
    auto c = single_.candidates.begin();
    for (std::size_t varied = 0; varied < kMost;) {
      std::vector<Beside> beside;
      const std::size_t most = std::min(kMost - varied, RankCount());
      for (; c != single_.candidates.end() && beside.size() < most; ++c) {
        if (context_.fitter.TimeIsOver() || HasFirst(beside, Key(c->hypothesis))) break;
        if (MayVary(*c, first, second)) AddBeside(*c, second, beside);
      }
      if (beside.empty()) return;
      varied += FitAll(beside);
    }
  }

  static bool HasFirst(const std::vector<Beside>& beside, const std::string& key) {
    return std::any_of(beside.begin(), beside.end(),
                       [&](const Beside& one) { return Key(one.first->hypothesis) == key; });
  }

  bool MayVary(const CandidateResult& c, const CandidateResult& first,
               const CandidateResult& second) const {
    constexpr double kAlike = 0.9;
    const bool alike = c.was_fitted && c.likelihood >= kAlike * first.likelihood;
    const std::set<std::string> both{Key(c.hypothesis), Key(second.hypothesis)};
    return alike && both.size() == 2 && !IsFitted(both);
  }

  bool IsFitted(const std::set<std::string>& pair) const {
    return std::any_of(tried_.begin(), tried_.end(), [&](const Beside& one) {
      const auto& seconds = one.search.candidates;
      return std::any_of(seconds.begin(), seconds.end(), [&](const CandidateResult& c) {
        return pair == std::set{Key(one.first->hypothesis), Key(c.hypothesis)};
      });
    });
  }

  // The second one is to begin where it has ended beside another first one. Nothing where there is
  // no such pair.
  void AddBeside(const CandidateResult& first, const CandidateResult& second,
                 std::vector<Beside>& beside) {
    const CandidateResult* const base = Completed(first);
    if (!base) return;
    auto inside =
        context_.options.Inside(DiagnosisStage::kSecondCause, "beside " + Key(first.hypothesis));
    inside.candidates = {second.hypothesis.effect};
    CandidateSearch search({context_.fitter, context_.noise, context_.sizes, inside},
                           {&base->hypothesis.system, base->hypothesis.Free(), &base->fitted});
    auto& all = search.candidates;
    std::erase_if(all, [&](const CandidateResult& c) {
      return Key(c.hypothesis) != Key(second.hypothesis) ||
             c.hypothesis.extra.size() != second.hypothesis.extra.size();
    });
    if (all.empty()) return;
    all.front().other_starts = StartsBeside(*base, second);
    search.CountAs(single_);
    beside.push_back({base, std::move(search)});
  }

  // Each with its only candidate. How many could be fitted.
  std::size_t FitAll(std::vector<Beside>& beside) {
    const auto second = [&](std::size_t i) -> CandidateResult& {
      return beside[i].search.candidates.front();
    };
    const auto fit = [&](std::size_t i) {
      try {
        second(i) = beside[i].search.FitAlone(second(i));
      } catch (const Error&) {
        return;  // there is no such pair
      }
    };
    ShareTasks(beside.size(), fit, [&](auto& a, std::size_t i) { FieldsOfFitAlone(a, second(i)); });
    const std::size_t before = tried_.size();
    for (std::size_t i = 0; i < beside.size(); ++i)
      if (second(i).was_fitted) tried_.push_back(std::move(beside[i]));
    return tried_.size() - before;
  }

  // The fit of a cause without another; null when it has none.
  const CandidateResult* Alone(const std::string& key) {
    for (const auto* all : {&single_.candidates, &single_.dismissed}) {
      for (const CandidateResult& c : *all) {
        if (Key(c.hypothesis) != key) continue;
        if (c.fitted.complete()) return &c;
        try {
          return &alone_.emplace_back(single_.FitAlone(c));
        } catch (const Error&) {
          return nullptr;
        }
      }
    }
    return nullptr;
  }

  // Every pair of causes that both are there, once, best first.
  std::vector<PairFit> All() {
    std::map<std::set<std::string>, PairFit> all;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      auto& candidates = tried_[t].search.candidates;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const PairFit one{t, i, tried_[t].first, &candidates[i]};
        if (!one.BothAreThere()) continue;
        const auto [at, fresh] =
            all.try_emplace({Key(one.a->hypothesis), Key(one.b->hypothesis)}, one);
        if (!fresh && IsBetter(one, at->second)) at->second = one;
      }
    }
    std::vector<PairFit> list;
    for (const auto& [keys, one] : all) list.push_back(one);
    std::stable_sort(list.begin(), list.end(), [](const PairFit& a, const PairFit& b) {
      return a.likelihood() > b.likelihood();
    });
    const auto begin = std::find_if(list.begin(), list.end(), std::mem_fn(&PairFit::complete));
    list.erase(list.begin(), begin);  // these were out of time
    return list;
  }

  // Of two fits of one pair; where both say the same, the one that corrects the model first.
  bool IsBetter(const PairFit& one, const PairFit& other) const {
    if (one.complete() != other.complete()) return one.complete();
    const double difference = std::abs(one.likelihood() - other.likelihood());
    const bool same = difference < std::max<double>(criteria_.rival_margin,
                                                    criteria_.same_share * one.likelihood());
    if (same && one.FirstCorrects(context_) != other.FirstCorrects(context_))
      return one.FirstCorrects(context_);
    return one.likelihood() > other.likelihood();
  }

  // A pair contains another when they share a cause and its other one contains the other's,
  // whichever was the first.
  bool Inside(const PairFit& outer, const PairFit& inner) const {
    const std::array<const CandidateResult*, 2> of_outer{outer.a, outer.b},
        of_inner{inner.a, inner.b};
    for (const int i : {0, 1}) {
      for (const int j : {0, 1}) {
        if (Key(of_outer[i]->hypothesis) == Key(of_inner[j]->hypothesis) &&
            Contains(context_.fitter, *of_outer[1 - i], *of_inner[1 - j]))
          return true;
      }
    }
    return false;
  }

  std::vector<LikelihoodRecord> RecordsOf(const std::vector<PairFit>& pairs) const {
    std::vector<LikelihoodRecord> records;
    for (const PairFit& p : pairs) {
      const Hypothesis &a = p.a->hypothesis, &b = p.b->hypothesis;
      LikelihoodRecord record{
          a.Name() + " and " + b.Name(), a.extra.size() + b.extra.size(), p.likelihood(), {}};
      record.kin = KinOf(a.Card(), b.Card());
      record.error_share = single_.ErrorShare(p.b->fitted);
      record.far_off = p.AnyIsFarOff(criteria_);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (&pairs[i] != &p && Inside(p, pairs[i])) record.contains.push_back(i);
      }
      records.push_back(std::move(record));
    }
    return records;
  }

  void TakeBest(const std::vector<PairFit>& pairs, PairsFound& found) {
    const auto records = RecordsOf(pairs);
    Verdict verdict = JudgeLikelihoods(records, {}, 0, single_.Base(), criteria_);
    if (verdict.named.empty()) return;
    const std::size_t likeliest = verdict.named.front();
    if (!Complete(pairs[likeliest])) return;
    LackOfFit lack = LackOf(pairs[likeliest]);
    verdict = JudgeLikelihoods(records, lack, 0, single_.Base(), criteria_);
    // Where more than noise is left a plainer pair may be enough.
    const PairFit& best = pairs[verdict.named.empty() ? likeliest : verdict.named.front()];
    if (!Complete(best)) return;
    if (&best != &pairs[likeliest]) lack = LackOf(best);
    const bool matters = SecondShare(best) >= criteria_.second_share ||
                         (TakesTheRest(best) && !best.SecondCorrects(context_));
    found.would_take = InWords(best);
    if (!matters || verdict.named.empty()) return;
    Partner first = FirstOf(pairs, verdict);
    for (auto* const some : {&verdict.named, &verdict.siblings, &verdict.far_off}) {
      std::vector<std::size_t> seconds;
      for (const std::size_t n : *some) {
        if (pairs[n].base == best.base) seconds.push_back(pairs[n].second);
      }
      *some = seconds;
    }
    if (verdict.named.empty()) return;
    verdict.leading = verdict.named.front();
    found.best.emplace(Pair{std::move(tried_[best.base].search), std::move(first),
                            best.a->likelihood, std::move(verdict), lack});
  }

  // A plain pair that was behind others of its search, and is to speak for them, has no
  // sensitivities so far. False: it diverges next to its fit.
  bool Complete(const PairFit& pair) const {
    if (pair.complete()) return true;
    try {
      context_.fitter.Complete(ProblemOf(*pair.b, *context_.fitter.experiment), pair.b->fitted);
      return pair.BothAreThere();
    } catch (const Error&) {
      return false;
    }
  }

  LackOfFit LackOf(const PairFit& pair) const {
    const CandidateSearch& search = tried_[pair.base].search;
    return of_step_ ? search.TestsOf(*pair.b) : search.LackOf(pair.b);
  }

  // Whether the first cause explains more than the second one, each by itself: then it does so on
  // average of both orders as well.
  bool IsMain(const PairFit& pair) const {
    const CandidateResult* const alone = Single(*pair.b);
    return !alone || pair.a->likelihood >= alone->likelihood;
  }

  // Which of both only changes numbers of the model by as little as they may be off, or does what
  // lengths and masses would do in its place.
  Partner::Correction CorrectionOf(const PairFit& pair) const {
    using Correction = Partner::Correction;
    const bool first = pair.FirstCorrects(context_), second = pair.SecondCorrects(context_);
    if (first && second) return Correction::kBoth;
    if (first) return Correction::kThis;
    if (second || DoLengthsAndMasses(*pair.a, pair.b->likelihood)) return Correction::kOther;
    const CandidateResult* const alone = Single(*pair.b);
    return alone && DoLengthsAndMasses(*alone, pair.likelihood() - alone->likelihood)
               ? Correction::kThis
               : Correction::kNone;
  }

  // Whether they explain about as much beside a cause as the other one of a pair does.
  bool DoLengthsAndMasses(const CandidateResult& beside, double other) const {
    const Hypothesis& h = beside.hypothesis;
    const ByLengthsAndMasses by = ExplainedByLengthsAndMasses(context_.fitter, context_.sizes,
                                                              h.system, h.Free(), beside.fitted);
    return MayBeLengthsAndMasses(by, other, criteria_);
  }

  // The first cause of the best pair, and what of the other pairs in the set could stand for it.
  Partner FirstOf(const std::vector<PairFit>& pairs, const Verdict& verdict) const {
    const PairFit& best = pairs[verdict.named.front()];
    Partner first{best.a->hypothesis};
    first.correction = CorrectionOf(best);
    const bool one = first.Corrects() != first.OtherCorrects();
    first.main = one ? first.OtherCorrects() : IsMain(best);
    NamesOfASet taken;
    taken.Insert(best.a->hypothesis), taken.Insert(best.b->hypothesis);
    for (const std::size_t n : verdict.named) {
      if (pairs[n].base == best.base) taken.Insert(pairs[n].b->hypothesis);
    }
    const auto add = [&](const std::vector<std::size_t>& some, auto& for_first, auto& for_second) {
      for (const std::size_t n : some) {
        const Hypothesis &a = pairs[n].a->hypothesis, &b = pairs[n].b->hypothesis;
        const std::string& first_effect = best.a->hypothesis.effect;
        const bool has_first = a.effect == first_effect || b.effect == first_effect;
        auto& others = has_first ? for_second : for_first;
        taken.Add(a, first.relatives, others), taken.Add(b, first.relatives, others);
      }
    };
    add(verdict.named, first.equivalent, first.instead);
    std::vector<std::string> of_second;  // they are siblings that the verdict has
    add(verdict.siblings, first.relatives, of_second);
    AddTheSame(*best.a, taken, first.relatives, first.equivalent);
    if (const CandidateResult* const alone = Single(*best.b))
      AddTheSame(*alone, taken, first.relatives, first.instead);
    return first;
  }

  // Effects of other families that say by themselves what this one says, as an offset of a winch
  // and a slack cable: beside another cause they would too. Of each family one; others of it are
  // relatives. One that contains it says no more.
  void AddTheSame(const CandidateResult& cause, NamesOfASet& taken,
                  std::vector<std::string>& relatives, std::vector<std::string>& others) const {
    for (const CandidateResult& c : single_.candidates) {
      const bool kin = KinOf(c.hypothesis.Card()).Of(KinOf(cause.hypothesis.Card()));
      if (!c.was_fitted || kin || Contains(context_.fitter, c, cause)) continue;
      if (SayTheSame(c, cause)) taken.Add(c.hypothesis, relatives, others);
    }
  }

  bool SayTheSame(const CandidateResult& a, const CandidateResult& b) const {
    const auto train = TrainLogs(*context_.fitter.experiment);
    const auto& whitening = context_.fitter.whitening;
    return (whitening.Stack(a.fitted.residuals, train) - whitening.Stack(b.fitted.residuals, train))
               .squaredNorm() <= criteria_.same_noise;
  }

  // The fit of a cause of a pair by itself, if it had one.
  const CandidateResult* Single(const CandidateResult& cause) const {
    const auto& all = single_.candidates;
    const auto at = std::find_if(all.begin(), all.end(), [&](const CandidateResult& c) {
      return c.was_fitted && Key(c.hypothesis) == Key(cause.hypothesis);
    });
    return at == all.end() ? nullptr : &*at;
  }

  // What the second cause takes of what can be explained at all, by the view that gives it more.
  double SecondShare(const PairFit& pair) const {
    const double whitened = ShareOf({"", 0, pair.b->likelihood}, single_.Base());
    return std::max(whitened,
                    single_.ErrorShare(pair.b->fitted) - single_.ErrorShare(pair.a->fitted));
  }

  // What the second cause takes of the squares above the noise that the first leaves.
  double ShareOfRest(const PairFit& pair) const {
    const BaseSquares base = single_.Base();
    const double left = base.squares - base.freedom - pair.a->likelihood;
    return std::clamp(pair.b->likelihood / std::max(left, 1e-300), 0.0, 1.0);
  }

  // A cause that is small beside the first; on logs that were not fitted too.
  bool TakesTheRest(const PairFit& pair) const {
    const TwoErrors &before = pair.a->fitted.error, &after = pair.b->fitted.error;
    const double floor = context_.noise.floor();
    const auto falls = [&](double from, double to) {
      return WithoutPart(to, floor) <= (1 - criteria_.median_gain) * WithoutPart(from, floor);
    };
    return ShareOfRest(pair) >= criteria_.main_share && falls(before.train, after.train) &&
           (before.validate == 0 || falls(before.validate, after.validate));
  }

  std::string InWords(const PairFit& pair) const {
    return fmt::format("{} beside {} takes {:.0f} % of that", pair.b->hypothesis.NameAtPlace(),
                       pair.a->hypothesis.NameAtPlace(), 100 * ShareOfRest(pair));
  }

  // All that was fitted, best first.
  static std::vector<PairTried> List(const std::vector<PairFit>& pairs) {
    std::vector<PairTried> list;
    for (const PairFit& p : pairs)
      list.push_back({Key(p.a->hypothesis), Key(p.b->hypothesis), p.likelihood()});
    return list;
  }

  const SearchContext context_;
  const Criteria& criteria_;
  const CandidateSearch& single_;
  bool of_step_;
  std::deque<const CandidateResult*> waiting_;
  std::set<std::string> known_;
  std::deque<CandidateResult> alone_;  // where single_ has no complete fit
  std::deque<Beside> tried_;
  std::size_t bases_ = 0;  // that were searched for a second cause
};

}  // namespace

bool Pair::IsPlainAndEnough() const {
  const Hypothesis& second = search.candidates[verdict.named.front()].hypothesis;
  return verdict.complete && !IsRich(first.hypothesis) && !IsRich(second);
}

CandidateSearch ScreenBeside(const SearchContext& context, const CandidateResult& first,
                             const std::set<std::string>& hopeless) {
  const Experiment& e = *context.fitter.experiment;
  CandidateSearch search(context,
                         {&first.hypothesis.system, first.hypothesis.Free(), &first.fitted});
  const Problem beside = ProblemOf(first, e);
  const std::vector<bool> logs = LogsForALook(e, beside.step());
  search.Screen({EquationErrors(beside, first.fitted.fit.x, logs)}, nullptr, hopeless);
  return search;
}

PairsFound FindPair(const SearchContext& context, const CandidateSearch& single, bool of_step) {
  return PairSearch(context, single, of_step).Run();
}

}  // namespace continuum
