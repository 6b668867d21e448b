#include "identification/pairs.h"

#include <algorithm>
#include <deque>
#include <set>

#include "error.h"

namespace continuum {
namespace {

constexpr std::size_t kBases = 4;  // single causes that are tried as one of two

std::string Key(const Hypothesis& h) { return h.Name() + " at " + h.where; }

class Search {
 public:
  Search(const Trials& trials, const Round& single, const Noise& noise, const Sizes& sizes,
         const DiagnosisOptions& options)
      : trials_(trials), single_(single), noise_(noise), sizes_(sizes), options_(options) {}

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
  struct Tried {
    const CandidateResult* first;
    Round round;
    double total() const { return first->likelihood + round.leading()->likelihood; }
  };

  void Await(const CandidateResult& c) {
    if (known_.insert(Key(c.hypothesis)).second) waiting_.push_back(&c);
  }

  // The best second cause beside a first; it is the next first.
  void Extend(const CandidateResult& first) {
    if (options_.progress) options_.progress("a second cause beside " + Key(first.hypothesis));
    const Base base{&first.hypothesis.system, first.hypothesis.Free(), &first.fitted};
    Round round(trials_, base, noise_, sizes_, options_);
    round.Screen();
    if (!(round.smallest_p() < LikelihoodRules{}.level)) return;
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

  // The pair with the highest likelihood; its first cause is judged by the rounds of the others.
  std::optional<Pair> Best() {
    const auto best =
        std::max_element(tried_.begin(), tried_.end(),
                         [](const Tried& a, const Tried& b) { return a.total() < b.total(); });
    if (best == tried_.end()) return {};
    const Verdict verdict = JudgeLikelihoods(best->round.Records(), best->round.Lack().smallest(),
                                             best->round.smallest_p());
    if (verdict.named.empty()) return {};
    std::vector<std::string> equivalent;
    for (const Tried& other : tried_) {
      if (best->total() - other.total() >= LikelihoodRules{}.apart) continue;
      AddOthers(*best, other, equivalent);
    }
    return Pair{std::move(best->round), best->first->hypothesis, best->first->likelihood,
                std::move(equivalent), verdict};
  }

  // Effects of pairs about as likely as the best that could stand for its first cause.
  static void AddOthers(const Tried& best, const Tried& other,
                        std::vector<std::string>& equivalent) {
    const std::string& second = best.round.leading()->hypothesis.effect;
    const std::string& first = best.first->hypothesis.effect;
    const auto add = [&](const std::string& effect) {
      if (effect == first || effect == second) return;
      if (std::find(equivalent.begin(), equivalent.end(), effect) == equivalent.end())
        equivalent.push_back(effect);
    };
    add(other.first->hypothesis.effect);
    for (const CandidateResult& c : other.round.candidates) {
      const double total = other.first->likelihood + c.likelihood;
      if (best.total() - total < LikelihoodRules{}.apart && other.first != best.first)
        add(c.hypothesis.effect);
    }
  }

  const Trials& trials_;
  const Round& single_;
  const Noise& noise_;
  const Sizes& sizes_;
  const DiagnosisOptions& options_;
  std::deque<const CandidateResult*> waiting_;
  std::set<std::string> known_;
  std::deque<CandidateResult> alone_;  // where single_ has no complete fit
  std::vector<Tried> tried_;
};

}  // namespace

std::optional<Pair> FindPair(const Trials& trials, const Round& single, const Noise& noise,
                             const Sizes& sizes, const DiagnosisOptions& options) {
  return Search(trials, single, noise, sizes, options).Run();
}

}  // namespace continuum
