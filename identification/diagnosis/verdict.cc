#include "identification/diagnosis/verdict.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace continuum {
namespace {

// Candidates in the order of their scores, where one of them has to be named.
class Ranking {
 public:
  Ranking(const std::vector<LikelihoodRecord>& candidates, const Criteria& criteria)
      : candidates_(candidates), criteria_(criteria), order_(candidates.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
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
      if (candidates_[i].listed && Contains(f, i) && !Behind(f, i, criteria_.nested_margin))
        return i;
    }
    return f;
  }

  /// One that was not asked for and does clearly better; null when there is none.
  const LikelihoodRecord* Outdoing(std::size_t best) const {
    const std::size_t top = order_.front();
    const bool outdoes = !candidates_[top].listed && Behind(top, best, criteria_.rival_margin);
    return outdoes ? &candidates_[top] : nullptr;
  }

  /// Those that the data do not distinguish from the best, which comes first. Of a law and one that
  /// it contains the plain one says it, unless only the complicated one was asked for.
  std::vector<std::size_t> Near(std::size_t best) const {
    std::vector<std::size_t> near{best};
    for (const std::size_t i : order_) {
      if (i != best && !AddsNothing(i, best) && !Behind(best, i, criteria_.rival_margin))
        near.push_back(i);
    }
    const auto all = near;
    std::erase_if(near, [&](std::size_t i) {
      return std::any_of(all.begin(), all.end(), [&](std::size_t k) {
        return k != i && AddsNothing(i, k) && (candidates_[k].listed || !candidates_[i].listed);
      });
    });
    return near;
  }

  double Score(std::size_t i) const { return ScoreOf(candidates_[i], criteria_); }
  /// By how much the next one is behind.
  double Lead(std::size_t best) const {
    if (order_.size() < 2) return Score(best);
    return Score(best) - Score(order_[best == order_[0] ? 1 : 0]);
  }

 private:
  // By the smaller of both time-discretisation errors: one that leans on it far more than the other
  // does not profit from it.
  bool Behind(std::size_t i, std::size_t j, double least) const {
    const double open = criteria_.step_share * std::min(candidates_[i].step, candidates_[j].step);
    return Score(i) - Score(j) >= std::max(least, open);
  }
  bool Contains(std::size_t a, std::size_t b) const {
    const auto& inner = candidates_[a].contains;
    return std::find(inner.begin(), inner.end(), b) != inner.end();
  }
  // To the one that it contains. Where only the time step leaves that open, both stay.
  bool AddsNothing(std::size_t a, std::size_t b) const {
    return Contains(a, b) && Score(a) - Score(b) < criteria_.nested_margin;
  }

  const std::vector<LikelihoodRecord>& candidates_;
  const Criteria& criteria_;
  std::vector<std::size_t> order_;
};

Verdict Adequate(const LackOfFit& lack, double p, const Criteria& criteria) {
  const std::string why =
      p < criteria.significance
          ? "no candidate's fit gains more than its parameters gain from noise alone"
          : fmt::format("noise alone lets the best candidate do as well with p = {:.2g}", p);
  return {Verdict::Kind::kAdequate,
          {},
          fmt::format("the model's residual shows {}: {}", ResidualInWords(lack, criteria), why)};
}

Verdict Name(const Ranking& all, std::size_t best, const LackOfFit& lack,
             const Criteria& criteria) {
  Verdict verdict{Verdict::Kind::kNamed};
  std::string unlisted;
  bool close = true;
  for (const std::size_t i : all.Near(best)) {
    const LikelihoodRecord& one = all.of(i);
    (one.listed ? verdict.named : verdict.unlisted).push_back(i);
    if (!one.listed) unlisted += (unlisted.empty() ? "" : ", ") + one.name;
    close = close && all.Score(best) - all.Score(i) < criteria.rival_margin;
  }
  const std::string near = fmt::format("within {:g}{}", +criteria.rival_margin,
                                       close ? "" : " or what the time step leaves open");
  const std::string shows = "its residual shows " + ResidualInWords(lack, criteria);
  if (verdict.named.size() > 1) {
    verdict.kind = Verdict::Kind::kAmbiguous;
    verdict.reason =
        fmt::format("the likelihoods of {} candidates are {}", verdict.named.size(), near);
  } else if (verdict.unlisted.empty()) {
    verdict.reason = fmt::format(
        "{}, and the next candidate is {:.1f} behind in 2 ln L, less {:g} for each parameter",
        shows, all.Lead(best), +criteria.parameter_cost);
  } else {
    verdict.reason = shows;
  }
  if (!unlisted.empty())
    verdict.reason += fmt::format("; not listed, but as likely ({}): {}", near, unlisted);
  return verdict;
}

Verdict Unexplained(std::string reason) {
  return {Verdict::Kind::kUnexplained, {}, std::move(reason)};
}

}  // namespace

std::string Verdict::word() const {
  switch (kind) {
    case Kind::kAdequate:
      return "adequate";
    case Kind::kNamed:
      return "named";
    case Kind::kAmbiguous:
      return "ambiguous";
    case Kind::kUnexplained:
      return "unexplained";
  }
  return "";
}

double ScoreOf(const LikelihoodRecord& record, const Criteria& criteria) {
  return record.likelihood - criteria.parameter_cost * static_cast<double>(record.parameters - 1);
}

std::vector<double> ProbabilitiesOf(const std::vector<LikelihoodRecord>& candidates,
                                    const Criteria& criteria) {
  double best = 0, sum = 0;
  for (const auto& c : candidates) best = std::max(best, ScoreOf(c, criteria));
  std::vector<double> out;
  for (const auto& c : candidates) out.push_back(std::exp(0.5 * (ScoreOf(c, criteria) - best)));
  for (const double v : out) sum += v;
  for (double& v : out) v /= std::max(sum, 1e-300);
  return out;
}

std::string ResidualInWords(const LackOfFit& lack, const Criteria& criteria) {
  if (lack.of_step) return "nothing beyond the noise and the time-discretisation error";
  if (lack.smallest() >= criteria.plain_noise) return "nothing but noise";
  return fmt::format("nothing that is significant at the level {:g} (p = {:.2g})",
                     +criteria.lack_of_fit, lack.smallest());
}

Verdict JudgeLikelihoods(const std::vector<LikelihoodRecord>& candidates, const LackOfFit& lack,
                         double p, const Criteria& criteria) {
  // First order may promise what no fit keeps.
  const bool kept = std::any_of(candidates.begin(), candidates.end(), [&](const auto& c) {
    return c.listed && ScoreOf(c, criteria) > criteria.parameter_cost;
  });
  const bool any = p < criteria.significance && kept;
  const bool more = lack.significant(criteria) && !lack.of_step;
  if (!any && more)
    return Unexplained("the residual shows something beside noise that no candidate explains");
  if (!any) return Adequate(lack, p, criteria);
  const Ranking all(candidates, criteria);
  if (more) {
    return Unexplained(fmt::format(
        "the residual of the best candidate, {}, shows more than noise (p = {:.2g}): another cause "
        "is at work, or one more",
        all.of(all.first()).name, lack.smallest()));
  }
  const std::size_t best = all.Best();
  if (const LikelihoodRecord* const other = all.Outdoing(best)) {
    Verdict verdict = Unexplained(
        fmt::format("the best candidate, {}, is clearly outdone by {}, which is not listed",
                    all.of(best).name, other->name));
    verdict.unlisted_explains = true;
    return verdict;
  }
  return Name(all, best, lack, criteria);
}

}  // namespace continuum
