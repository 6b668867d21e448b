#include "identification/diagnosis/cause_pairs.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "error.h"

namespace continuum {
namespace {

constexpr std::size_t kBases = 4;   // single causes that are tried as one of two
constexpr double kPromising = 0.5;  // of what a first cause leaves, where that may be the time step

std::string Key(const Hypothesis& h) { return h.Name() + " at " + h.where; }

// Whether the interval of a size leaves out its absence. It reaches over what the time step does.
bool IsThere(const Hypothesis& h, const Fitted& f, Eigen::Index begin) {
  for (const std::size_t a : h.Amplitudes()) {
    const Eigen::Index i = begin + static_cast<Eigen::Index>(a);
    const double null = std::min(h.null[a], h.extra[a].upper);
    if (null < f.uncertainty.lower[i] || null > f.uncertainty.upper[i]) return true;
  }
  return false;
}

// A first cause, and the round for a second beside it.
struct Beside {
  const CandidateResult* first;
  CandidateSearch round;
};

// One pair that was fitted.
struct Fitting {
  std::size_t base;    // index of its Beside
  std::size_t second;  // index in its round
  const CandidateResult *a, *b;

  double likelihood() const { return a->likelihood + b->likelihood; }
  bool BothAreThere() const {
    if (!b->fitted.complete) return true;  // plainly behind
    const auto first = static_cast<Eigen::Index>(a->hypothesis.extra.size());
    return IsThere(a->hypothesis, b->fitted, b->own() - first) &&
           IsThere(b->hypothesis, b->fitted, b->own());
  }
  bool Has(const std::string& effect) const {
    return a->hypothesis.effect == effect || b->hypothesis.effect == effect;
  }
};

class Search {
 public:
  Search(const CandidateFitter& trials, const CandidateSearch& single, bool excused,
         const Noise& noise, const Sizes& sizes, const DiagnosisOptions& options)
      : trials_(trials),
        single_(single),
        excused_(excused),
        noise_(noise),
        sizes_(sizes),
        options_(options) {}

  std::optional<Pair> Run() {
    std::set<std::string> effects;
    for (const CandidateResult& c : single_.candidates) {
      if (c.fitted.complete && effects.size() < 2 && effects.insert(c.hypothesis.effect).second)
        Await(c);
    }
    while (!waiting_.empty() && tried_.size() < kBases) {
      const CandidateResult* const base = waiting_.front();
      waiting_.pop_front();
      Extend(*base);
    }
    return Best();
  }

 private:
  void Await(const CandidateResult& c) {
    if (known_.insert(Key(c.hypothesis)).second) waiting_.push_back(&c);
  }

  // The best second cause beside a first; it is the next first.
  void Extend(const CandidateResult& first) {
    options_.Say("a second cause beside " + Key(first.hypothesis));
    const Base base{&first.hypothesis.system, first.hypothesis.Free(), &first.fitted};
    CandidateSearch round(trials_, base, noise_, sizes_, options_);
    round.Screen();
    if (!(round.smallest_p() < LikelihoodRules{}.level)) return;
    if (excused_ && round.Promise() < kPromising) return;
    round.Fit();
    if (!round.leading()) return;
    const std::string partner = Key(round.leading()->hypothesis);
    tried_.push_back({&first, std::move(round)});
    if (const CandidateResult* const next = Alone(partner)) Await(*next);
  }

  // The fit of a cause without another; null when it has none.
  const CandidateResult* Alone(const std::string& key) {
    for (const auto* all : {&single_.candidates, &single_.left_behind}) {
      for (const CandidateResult& c : *all) {
        if (Key(c.hypothesis) != key) continue;
        if (c.fitted.complete) return &c;
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
  std::vector<Fitting> All() const {
    std::map<std::set<std::string>, Fitting> all;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      const auto& candidates = tried_[t].round.candidates;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Fitting one{t, i, tried_[t].first, &candidates[i]};
        if (!one.BothAreThere()) continue;
        const auto [at, fresh] =
            all.try_emplace({Key(one.a->hypothesis), Key(one.b->hypothesis)}, one);
        if (!fresh && at->second.likelihood() < one.likelihood()) at->second = one;
      }
    }
    std::vector<Fitting> list;
    for (const auto& [keys, one] : all) list.push_back(one);
    std::stable_sort(list.begin(), list.end(), [](const Fitting& a, const Fitting& b) {
      return a.likelihood() > b.likelihood();
    });
    return list;
  }

  // A pair contains another when they share a cause and its other one contains the other's.
  bool Inside(const Fitting& outer, const Fitting& inner) const {
    return (outer.base == inner.base && Contains(trials_, *outer.b, *inner.b)) ||
           (Key(outer.b->hypothesis) == Key(inner.b->hypothesis) &&
            Contains(trials_, *outer.a, *inner.a));
  }

  std::vector<LikelihoodRecord> RecordsOf(const std::vector<Fitting>& pairs) const {
    std::vector<LikelihoodRecord> records;
    for (const Fitting& p : pairs) {
      const Hypothesis &a = p.a->hypothesis, &b = p.b->hypothesis;
      LikelihoodRecord record{
          a.Name() + " and " + b.Name(), a.extra.size() + b.extra.size(), p.likelihood(), {}};
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (&pairs[i] != &p && Inside(p, pairs[i])) record.contains.push_back(i);
      }
      records.push_back(std::move(record));
    }
    return records;
  }

  std::optional<Pair> Best() {
    const auto pairs = All();
    if (pairs.empty()) return {};
    const auto records = RecordsOf(pairs);
    Verdict verdict = JudgeLikelihoods(records, 1, 0);
    if (verdict.named.empty()) return {};
    const Fitting& best = pairs[verdict.named.front()];
    if (!best.b->fitted.complete) return {};  // those before it were no two causes
    const CandidateSearch& round = tried_[best.base].round;
    const LackOfFit lack = round.LackOf(*best.b);
    LikelihoodRules rules;
    rules.excused = lack.smallest() < rules.lack && !excused_ &&
                    trials_.WithinStep(best.b->fitted) && round.GoesWithTheStep(*best.b);
    verdict = JudgeLikelihoods(records, lack.smallest(), 0, rules);
    if (verdict.named.empty()) return {};
    const auto equivalent = OthersForFirst(pairs, verdict);
    auto tried = List(pairs);
    std::vector<std::size_t> seconds;
    for (const std::size_t n : verdict.named) {
      if (pairs[n].base == best.base) seconds.push_back(pairs[n].second);
    }
    verdict.named = seconds;
    return Pair{std::move(tried_[best.base].round),
                best.a->hypothesis,
                best.a->likelihood,
                equivalent,
                std::move(verdict),
                lack,
                std::move(tried)};
  }

  // Effects of pairs in the set that are neither of the best pair's, nor stand for its second.
  static std::vector<std::string> OthersForFirst(const std::vector<Fitting>& pairs,
                                                 const Verdict& verdict) {
    const Fitting& best = pairs[verdict.named.front()];
    std::set<std::string> taken{best.a->hypothesis.effect, best.b->hypothesis.effect};
    for (const std::size_t n : verdict.named) {
      if (pairs[n].base == best.base) taken.insert(pairs[n].b->hypothesis.effect);
    }
    std::vector<std::string> others;
    for (const std::size_t n : verdict.named) {
      for (const CandidateResult* const c : {pairs[n].a, pairs[n].b}) {
        if (taken.insert(c->hypothesis.effect).second) others.push_back(c->hypothesis.effect);
      }
    }
    return others;
  }

  static std::vector<PairTried> List(const std::vector<Fitting>& pairs) {
    std::vector<PairTried> list;
    for (const Fitting& p : pairs)
      list.push_back({Key(p.a->hypothesis), Key(p.b->hypothesis), p.likelihood()});
    return list;
  }

  const CandidateFitter& trials_;
  const CandidateSearch& single_;
  bool excused_;
  const Noise& noise_;
  const Sizes& sizes_;
  const DiagnosisOptions& options_;
  std::deque<const CandidateResult*> waiting_;
  std::set<std::string> known_;
  std::deque<CandidateResult> alone_;  // where single_ has no complete fit
  std::deque<Beside> tried_;
};

}  // namespace

std::optional<Pair> FindPair(const CandidateFitter& trials, const CandidateSearch& single,
                             bool excused, const Noise& noise, const Sizes& sizes,
                             const DiagnosisOptions& options) {
  return Search(trials, single, excused, noise, sizes, options).Run();
}

}  // namespace continuum
