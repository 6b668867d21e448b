#include "identification/diagnosis/verdict.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace continuum {

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::vector<double> Gains(const FoldRecord& record) {
  std::vector<double> gains;
  for (std::size_t f = 0; f < record.after.size(); ++f) {
    gains.push_back(record.before[f] > 0 ? 1 - record.after[f] / record.before[f] : 0);
  }
  return gains;
}

double Beaten(const FoldRecord& candidate, const std::vector<double>& placebo_gains) {
  const double own = Median(Gains(candidate));
  return static_cast<double>(std::count_if(placebo_gains.begin(), placebo_gains.end(),
                                           [own](double placebo) { return placebo < own; }));
}

std::vector<std::string> Failures(const FoldRecord& record, const Rules& rules) {
  std::vector<std::string> failures;
  const auto gains = Gains(record);
  if (record.after.empty()) {
    return {fmt::format("its fit lowers the error by less than {:.0f} % where it was fitted",
                        100 * rules.fit_gain)};
  }
  const double n = static_cast<double>(gains.size());
  const double better = static_cast<double>(
      std::count_if(gains.begin(), gains.end(), [](double g) { return g > 0; }));
  if (n < 2) failures.push_back("fewer than two folds");
  if (better < rules.folds_better * n - 1e-9) {
    failures.push_back(fmt::format("the error falls in only {:.0f} of {:.0f} folds", better, n));
  }
  if (!(Median(gains) >= rules.median_gain)) {
    failures.push_back(
        fmt::format("the error falls by {:.1f} % in the median, {:.0f} % are asked for",
                    100 * Median(gains), 100 * rules.median_gain));
  }
  const double middle = Median(record.amplitude);
  for (const double a : record.amplitude) {
    if (std::abs(a - middle) <= rules.amplitude_spread * std::abs(middle) && middle != 0) continue;
    failures.push_back(fmt::format("its size varies over the folds by more than {:.0f} %",
                                   100 * rules.amplitude_spread));
    break;
  }
  if (!record.placebo_gains.empty()) {
    const double beaten = Beaten(record, record.placebo_gains);
    const double all = static_cast<double>(record.placebo_gains.size());
    if (beaten < rules.placebo_share * all) {
      failures.push_back(
          fmt::format("it beats only {:.0f} of {:.0f} random smooth forces", beaten, all));
    }
  }
  return failures;
}

bool ClearlyBetter(const FoldRecord& a, const FoldRecord& b, double margin) {
  const std::size_t n = a.after.size();
  if (n < 2) return false;
  double mean = 0, squares = 0;
  std::size_t wins = 0;
  std::vector<double> removed;     // of b's error
  std::vector<double> difference;  // in units of the fold's error, so that no fold dominates
  for (std::size_t f = 0; f < n; ++f) {
    removed.push_back(1 - a.after[f] / std::max(1e-300, b.after[f]));
    difference.push_back((b.after[f] - a.after[f]) / std::max(1e-300, a.before[f]));
    mean += difference.back() / static_cast<double>(n);
    wins += difference.back() > 0;
  }
  for (const double d : difference) squares += (d - mean) * (d - mean);
  const double error = std::sqrt(squares / static_cast<double>(n - 1) / static_cast<double>(n));
  const bool mostly =
      static_cast<double>(wins) >= Rules{}.folds_better * static_cast<double>(n) - 1e-9;
  return mean > error && mostly && Median(removed) > margin;
}

namespace {

// What the best random force but the luckiest few removes of the error.
double OfPlacebos(std::vector<double> gains, const Rules& rules) {
  if (gains.empty()) return 0;
  std::sort(gains.begin(), gains.end());
  const double last = static_cast<double>(gains.size() - 1);
  return gains[static_cast<std::size_t>(rules.placebo_share * last)];
}

// Only as deep as the folds allow: the plainest of those that each other's better contains, unless
// it is clearly worse.
std::size_t Plainest(const std::vector<FoldRecord>& candidates,
                     const std::vector<std::size_t>& passing, double margin) {
  std::size_t best = passing.front();
  for (const std::size_t i : passing) {
    const auto& inner = candidates[best].contains;
    const bool inside = std::find(inner.begin(), inner.end(), i) != inner.end();
    if (inside && !ClearlyBetter(candidates[passing.front()], candidates[i], margin)) best = i;
  }
  return best;
}

}  // namespace

Verdict Judge(const std::vector<FoldRecord>& candidates, double noise_over, double ceiling_gain,
              const Rules& rules) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto gain = [&](std::size_t i) { return Median(Gains(candidates[i])); };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return gain(a) > gain(b); });

  if (noise_over > 0 && noise_over < 1.1) {
    return {
        "adequate", {}, fmt::format("what the model leaves is {:.2f} times the noise", noise_over)};
  }
  std::vector<std::size_t> passing;
  for (const std::size_t i : order) {
    if (Failures(candidates[i], rules).empty()) passing.push_back(i);
  }
  if (passing.empty()) {
    if (rules.over_scatter > rules.too_much) {
      return {"unexplained",
              {},
              fmt::format("no candidate passes all rules, and the model leaves {:.0f} times what "
                          "the measurement scatters from row to row",
                          rules.over_scatter)};
    }
    if (noise_over == 0 && ceiling_gain < rules.median_gain) {
      return {"adequate",
              {},
              fmt::format("no candidate and no smooth force removes {:.0f} % of the error, and "
                          "without replicates the noise is not known",
                          100 * rules.median_gain)};
    }
    return {"unexplained", {}, "no candidate passes all rules"};
  }
  const double margin =
      std::max(rules.apart, OfPlacebos(candidates[passing.front()].placebo_gains, rules));
  const std::size_t best = Plainest(candidates, passing, margin);
  const double left = candidates[best].remaining;
  if (left > rules.noise_reached && left < rules.noise_limited) {
    return {
        "unexplained",
        {},
        fmt::format("the best candidate, {}, leaves {:.1f} times the noise: another cause is at "
                    "work, or one more",
                    candidates[best].name, left)};
  }
  Verdict verdict{"named", {best}, ""};
  for (const std::size_t i : order) {
    if (i == best || gain(i) < 0.5 * gain(best)) continue;
    if (ClearlyBetter(candidates[best], candidates[i], margin)) continue;
    const auto& inner = candidates[i].contains;
    if (std::find(inner.begin(), inner.end(), best) != inner.end()) continue;  // says no more
    verdict.named.push_back(i);
  }
  if (verdict.named.size() > 1) {
    verdict.text = "ambiguous";
    verdict.reason =
        "the folds do not tell " + std::to_string(verdict.named.size()) + " candidates apart";
  } else {
    verdict.reason = "it passes all rules and is clearly better than every other candidate";
  }
  return verdict;
}

double ScoreOf(const LikelihoodRecord& record, const LikelihoodRules& rules) {
  return record.likelihood - rules.parameter * static_cast<double>(record.parameters - 1);
}

std::vector<double> ProbabilitiesOf(const std::vector<LikelihoodRecord>& candidates,
                                    const LikelihoodRules& rules) {
  double best = 0, sum = 0;
  for (const auto& c : candidates) best = std::max(best, ScoreOf(c, rules));
  std::vector<double> out;
  for (const auto& c : candidates) out.push_back(std::exp(0.5 * (ScoreOf(c, rules) - best)));
  for (const double v : out) sum += v;
  for (double& v : out) v /= std::max(sum, 1e-300);
  return out;
}

std::string LeftInWords(double lack, const LikelihoodRules& rules) {
  if (rules.excused) return "nothing beyond the noise and what the time step adds";
  constexpr double kPlain = 0.05;  // below it "noise" would say too much
  if (lack >= kPlain) return "nothing but noise";
  return fmt::format("nothing that is significant at the level {:g} (p = {:.2g})", rules.lack,
                     lack);
}

namespace {

// Who stands beside whom, where something has to be named.
class Comparison {
 public:
  Comparison(const std::vector<LikelihoodRecord>& candidates, const LikelihoodRules& rules)
      : candidates_(candidates), rules_(rules), order_(candidates.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return Score(a) > Score(b); });
  }

  /// The first of those that were asked for.
  std::size_t first() const {
    return *std::find_if(order_.begin(), order_.end(),
                         [&](std::size_t i) { return candidates_[i].listed; });
  }
  const LikelihoodRecord& of(std::size_t i) const { return candidates_[i]; }

  /// The first, or the best of those that it contains and does not clearly beat: only as deep as
  /// the data allow.
  std::size_t Best() const {
    const std::size_t f = first();
    for (const std::size_t i : order_) {
      if (candidates_[i].listed && Contains(f, i) && !Behind(f, i, rules_.deeper)) return i;
    }
    return f;
  }

  /// One that was not asked for and does clearly better; null when there is none.
  const LikelihoodRecord* Outdoing(std::size_t best) const {
    const std::size_t top = order_.front();
    const bool outdoes = !candidates_[top].listed && Behind(top, best, rules_.apart);
    return outdoes ? &candidates_[top] : nullptr;
  }

  /// Those that the data do not tell from the best, which comes first. Of a law and one that it
  /// contains the plain one says it, unless only the complicated one was asked for.
  std::vector<std::size_t> Near(std::size_t best) const {
    std::vector<std::size_t> near{best};
    for (const std::size_t i : order_) {
      if (i != best && !Idle(i, best) && !Behind(best, i, rules_.apart)) near.push_back(i);
    }
    const auto all = near;
    std::erase_if(near, [&](std::size_t i) {
      return std::any_of(all.begin(), all.end(), [&](std::size_t k) {
        return k != i && Idle(i, k) && (candidates_[k].listed || !candidates_[i].listed);
      });
    });
    return near;
  }

  double Score(std::size_t i) const { return ScoreOf(candidates_[i], rules_); }
  /// By how much the next one is behind.
  double Lead(std::size_t best) const {
    if (order_.size() < 2) return Score(best);
    return Score(best) - Score(order_[best == order_[0] ? 1 : 0]);
  }

 private:
  // The smaller step: one that leans on it far more than the other is not excused by it.
  bool Behind(std::size_t i, std::size_t j, double least) const {
    const double open = rules_.step * std::min(candidates_[i].step, candidates_[j].step);
    return Score(i) - Score(j) >= std::max(least, open);
  }
  bool Contains(std::size_t a, std::size_t b) const {
    const auto& inner = candidates_[a].contains;
    return std::find(inner.begin(), inner.end(), b) != inner.end();
  }
  // It has nothing to add: where only the time step leaves that open, both stay.
  bool Idle(std::size_t a, std::size_t b) const {
    return Contains(a, b) && Score(a) - Score(b) < rules_.deeper;
  }

  const std::vector<LikelihoodRecord>& candidates_;
  const LikelihoodRules& rules_;
  std::vector<std::size_t> order_;
};

Verdict NothingToName(double lack, double p, const LikelihoodRules& rules) {
  const std::string why =
      p < rules.level
          ? "no candidate's fit gains more than its parameters gain from noise alone"
          : fmt::format("noise alone lets the best candidate do as well with p = {:.2g}", p);
  return {"adequate", {}, fmt::format("the model leaves {}: {}", LeftInWords(lack, rules), why)};
}

Verdict Name(const Comparison& all, std::size_t best, double lack, const LikelihoodRules& rules) {
  Verdict verdict{"named", {}, ""};
  std::string unlisted;
  bool close = true;
  for (const std::size_t i : all.Near(best)) {
    const LikelihoodRecord& one = all.of(i);
    (one.listed ? verdict.named : verdict.unlisted).push_back(i);
    if (!one.listed) unlisted += (unlisted.empty() ? "" : ", ") + one.name;
    close = close && all.Score(best) - all.Score(i) < rules.apart;
  }
  const std::string near =
      fmt::format("within {:g}{}", rules.apart, close ? "" : " or what the time step leaves open");
  const std::string leaves = "it leaves " + LeftInWords(lack, rules);
  if (verdict.named.size() > 1) {
    verdict.text = "ambiguous";
    verdict.reason =
        fmt::format("the likelihoods of {} candidates are {}", verdict.named.size(), near);
  } else if (verdict.unlisted.empty()) {
    verdict.reason = fmt::format(
        "{}, and the next candidate is {:.1f} behind in 2 ln L, less {:g} for each parameter",
        leaves, all.Lead(best), rules.parameter);
  } else {
    verdict.reason = leaves;
  }
  if (!unlisted.empty())
    verdict.reason += fmt::format("; not listed, but as likely ({}): {}", near, unlisted);
  return verdict;
}

}  // namespace

Verdict JudgeLikelihoods(const std::vector<LikelihoodRecord>& candidates, double lack, double p,
                         const LikelihoodRules& rules) {
  // First order may promise what no fit keeps.
  const bool kept = std::any_of(candidates.begin(), candidates.end(), [&](const auto& c) {
    return c.listed && ScoreOf(c, rules) > rules.parameter;
  });
  const bool any = p < rules.level && kept;
  const bool more = lack < rules.lack && !rules.excused;
  if (!any && more) {
    return {"unexplained", {}, "something beside noise is left that no candidate explains"};
  }
  if (!any) return NothingToName(lack, p, rules);
  const Comparison all(candidates, rules);
  if (more) {
    return {"unexplained",
            {},
            fmt::format("the best candidate, {}, leaves more than noise (p = {:.2g}): another "
                        "cause is at work, or one more",
                        all.of(all.first()).name, lack)};
  }
  const std::size_t best = all.Best();
  if (const LikelihoodRecord* const other = all.Outdoing(best)) {
    return {"unexplained",
            {},
            fmt::format("the best candidate, {}, is clearly outdone by {}, which is not listed",
                        all.of(best).name, other->name)};
  }
  return Name(all, best, lack, rules);
}

}  // namespace continuum
