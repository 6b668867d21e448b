#include "identification/diagnosis/verdict.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "binding/effect_catalog.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

// Candidates in the order of their scores, where one of them has to be named.
class Ranking {
 public:
  // more: the best one's residual is more than noise.
  Ranking(const std::vector<LikelihoodRecord>& candidates, const BaseSquares& base, bool more,
          const Criteria& criteria)
      : candidates_(candidates),
        base_(base),
        more_(more),
        criteria_(criteria),
        order_(candidates.size()) {
    for (const LikelihoodRecord& one : candidates) most_ = std::max(most_, one.likelihood);
    left_ = std::max(0.0, base.squares - most_ - base.freedom);
    if (base.freedom > 0) scale_ = std::max(1.0, (base.squares - most_) / base.freedom);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return Score(a) > Score(b); });
  }

  /// The first of those that were asked for.
  std::size_t first() const {
    return *std::find_if(order_.begin(), order_.end(),
                         [&](std::size_t i) { return candidates_[i].listed; });
  }
  const LikelihoodRecord& of(std::size_t i) const { return candidates_[i]; }
  double share(std::size_t i) const { return ShareOf(candidates_[i], base_); }

  /// The first, or the plainest of its family or of what it contains that it does not clearly beat:
  /// only as deep as the data allow.
  std::size_t Best() const { return PlainestLike(first()); }

  /// The same, or where it is far off the first of those that do as well and are not.
  std::size_t BestNotFarOff() const {
    const std::size_t best = Best();
    if (!candidates_[best].far_off) return best;
    auto others = Siblings(best);
    const auto near = Near(best);
    others.insert(others.end(), near.begin(), near.end());
    for (const std::size_t i : others)
      if (candidates_[i].listed && !candidates_[i].far_off) return i;
    return best;
  }

  /// Others of the best one's family that do as well, or better; and laws that contain it and do
  /// better where they were fitted alone.
  std::vector<std::size_t> Siblings(std::size_t best) const {
    std::vector<std::size_t> siblings;
    for (const std::size_t i : order_) {
      if (i == best || !candidates_[i].listed) continue;
      const bool kin = AreKin(i, best) && IsEnough(i, first()) && !AddsNothing(i, best);
      if (kin || (HasNotEarned(i, best) && IsBehind(i, best))) siblings.push_back(i);
    }
    return siblings;
  }

  /// One of another family that was not asked for and does clearly better; null when there is none.
  /// Where the best of the list does not take the main share, one that does and does not contain
  /// it: with more numbers it would make up for what else is wrong.
  const LikelihoodRecord* Outdoing(std::size_t best, bool main) const {
    const auto one = NotAskedFor([&](std::size_t i) {
      const bool other = main || (!Contains(i, best) && share(i) >= criteria_.main_share);
      return other && !AreKin(i, best) && IsBehind(i, first());
    });
    return one ? &candidates_[PlainestLike(*one)] : nullptr;
  }

  /// One that was not asked for, that the best contains and adds nothing to; null when none.
  const LikelihoodRecord* SayingTheSame(std::size_t best) const {
    const auto one =
        NotAskedFor([&](std::size_t i) { return Contains(best, i) && AddsNothing(best, i); });
    return one ? &candidates_[*one] : nullptr;
  }

  /// The best, and those of other families, or not asked for, that the data do not distinguish from
  /// the best of its own. Of a law and one that it contains the plain one says it, unless only the
  /// complicated one was asked for.
  std::vector<std::size_t> Near(std::size_t best) const {
    std::vector<std::size_t> near{best};
    for (const std::size_t i : order_) {
      const bool sibling = AreKin(i, best) && candidates_[i].listed;
      if (i != best && !sibling && !AddsNothing(i, best) && !IsBehind(first(), i))
        near.push_back(i);
    }
    auto all = Siblings(best);  // what contains one of these says no more either
    all.insert(all.end(), near.begin(), near.end());
    std::erase_if(near, [&](std::size_t i) {
      return std::any_of(all.begin(), all.end(), [&](std::size_t k) {
        return k != i && AddsNothing(i, k) && (candidates_[k].listed || !candidates_[i].listed);
      });
    });
    return near;
  }

  double Score(std::size_t i) const { return ScoreOf(candidates_[i], criteria_, scale_); }
  /// By how much the next one of another family is behind.
  double Lead(std::size_t best) const {
    for (const std::size_t i : order_) {
      if (i != best && !AreKin(i, best)) return Score(best) - Score(i);
    }
    return Score(best);
  }

 private:
  // Of those that were asked for, as this one was, or of the others.
  std::size_t PlainestLike(std::size_t first) const {
    std::size_t best = first;
    for (const std::size_t i : order_) {
      if (candidates_[i].listed == candidates_[first].listed && IsPlainer(i, best) &&
          IsEnough(i, first) && (MayLeaveSome(first) || !Behind(first, i, OfNested())))
        best = i;
    }
    return best;
  }
  template <typename Test>
  std::optional<std::size_t> NotAskedFor(const Test& test) const {
    for (const std::size_t i : order_) {
      if (!candidates_[i].listed && test(i)) return i;
    }
    return {};
  }
  bool AreKin(std::size_t a, std::size_t b) const {
    return candidates_[a].kin.Of(candidates_[b].kin);
  }
  bool IsPlainer(std::size_t a, std::size_t b) const {
    return Contains(b, a) || candidates_[a].kin.PlainerThan(candidates_[b].kin);
  }
  // Whether a says what the first one of its family says, but for what a richer law has to earn.
  bool IsEnough(std::size_t a, std::size_t first) const {
    const bool most =
        AreKin(a, first) && !TakesTheRest(first, a) &&
        candidates_[a].likelihood >= criteria_.family_share * candidates_[first].likelihood;
    return most || HasNotEarned(first, a) || !Behind(first, a, OfNested());
  }
  // Whether a plain law of a family may leave more than noise beside the first one: where that does
  // too, and of dry friction, which others simulate in other ways.
  bool MayLeaveSome(std::size_t first) const {
    return more_ || candidates_[first].kin.family == kDryFriction;
  }
  // Whether a richer law takes the main share of what a plain one leaves plainly above noise and
  // time step, on logs left out.
  bool TakesTheRest(std::size_t rich, std::size_t plain) const {
    const double before = candidates_[plain].held_out, after = candidates_[rich].held_out;
    const double floor = base_.floor * base_.floor;
    return before > criteria_.plainly_more * base_.floor &&
           after * after - floor <= (1 - criteria_.main_share) * (before * before - floor);
  }
  // Where more than noise is left, a law that contains another one makes up for some of that.
  bool HasNotEarned(std::size_t rich, std::size_t plain) const {
    const double before = candidates_[plain].held_out, after = candidates_[rich].held_out;
    return more_ && Contains(rich, plain) && before > 0 &&
           after > (1 - criteria_.earned_share) * before;
  }
  bool IsBehind(std::size_t best, std::size_t rival) const {
    return Behind(best, rival, std::max(AtLeast(criteria_.rival_margin), OfStructure()));
  }
  // What lengths and masses may leave of what the best one explains.
  double OfStructure() const { return criteria_.structure_least * most_ / scale_; }
  // A richer law bends to that as well.
  double OfNested() const { return std::max(AtLeast(criteria_.nested_margin), OfStructure()); }
  // A margin, or what else is wrong with a model may make of one. What is left beside a number that
  // is a little off is other such numbers: the best of them explains no more than all of that.
  double AtLeast(double margin) const {
    if (!more_) return margin;
    const double share = candidates_[first()].corrects ? 1 : +criteria_.left_share;
    const double left = std::max<double>(share * left_, criteria_.structure_share * most_);
    return std::max(margin, left / scale_);
  }
  // By the smaller of both time-discretisation errors: one that leans on it far more than the other
  // does not profit from it.
  bool Behind(std::size_t i, std::size_t j, double least) const {
    const double open = criteria_.step_share * std::min(candidates_[i].step, candidates_[j].step);
    return Score(i) - Score(j) >= std::max(scale_ * least, open);
  }
  bool Contains(std::size_t a, std::size_t b) const {
    const auto& inner = candidates_[a].contains;
    return std::find(inner.begin(), inner.end(), b) != inner.end();
  }
  // To the one that it contains. Where only the time step leaves that open, both stay.
  bool AddsNothing(std::size_t a, std::size_t b) const {
    return HasNotEarned(a, b) || (Contains(a, b) && Score(a) - Score(b) < scale_ * OfNested());
  }

  const std::vector<LikelihoodRecord>& candidates_;
  const BaseSquares& base_;
  bool more_;
  const Criteria& criteria_;
  double most_ = 0;   // squares that the best one explains
  double left_ = 0;   // squares above the noise that the best one leaves
  double scale_ = 1;  // squares that the best one leaves over those of noise
  std::vector<std::size_t> order_;
};

Verdict Adequate(const LackOfFit& lack, double p, const Criteria& criteria) {
  const std::string why =
      p < criteria.significance
          ? "no candidate's fit gains more than its parameters gain from noise alone"
          : fmt::format("noise alone lets the best candidate do as well with p = {:.2g}", p);
  return Verdict::Adequate(
      fmt::format("the model's residual shows {}: {}", ResidualInWords(lack, criteria), why));
}

// What the residual of a named cause shows.
std::string Shows(const Ranking& all, std::size_t best, const LackOfFit& lack, bool more,
                  const Criteria& criteria) {
  if (!more) return "its residual shows " + ResidualInWords(lack, criteria);
  return fmt::format(
      "it explains {:.0f} % of what noise does not, and its residual shows more than "
      "noise",
      100 * all.share(best));
}

// Of each family the plainest law stands for it, and of these the likeliest.
void AddByFamily(const Ranking& all, std::size_t one, Verdict& verdict) {
  const Kin& kin = all.of(one).kin;
  const auto of_family = std::find_if(verdict.named.begin(), verdict.named.end(),
                                      [&](std::size_t i) { return kin.Of(all.of(i).kin); });
  if (of_family == verdict.named.end()) {
    verdict.named.push_back(one);
    return;
  }
  if (kin.PlainerThan(all.of(*of_family).kin)) std::swap(one, *of_family);
  verdict.siblings.push_back(one);
}

Verdict Name(const Ranking& all, std::size_t best, const LackOfFit& lack, bool more,
             const Criteria& criteria) {
  Verdict verdict{Verdict::Kind::kNamed};
  verdict.complete = !more;
  verdict.siblings = all.Siblings(best);
  std::string unlisted, far_off;
  bool close = true;
  for (const std::size_t i : all.Near(best)) {
    const LikelihoodRecord& one = all.of(i);
    if (one.far_off && !all.of(best).far_off) {
      far_off += (far_off.empty() ? "" : ", ") + one.name;
      if (one.listed) verdict.far_off.push_back(i);
      continue;
    }
    if (one.listed) {
      AddByFamily(all, i, verdict);
    } else {
      verdict.unlisted.push_back(i);
      unlisted += (unlisted.empty() ? "" : ", ") + one.name;
    }
    close = close && all.Score(best) - all.Score(i) < criteria.rival_margin;
  }
  const std::string near = fmt::format("within {:g}{}", +criteria.rival_margin,
                                       close  ? ""
                                       : more ? " or what else is left"
                                              : " or what time step and lengths leave open");
  const std::string shows = Shows(all, best, lack, more, criteria);
  if (verdict.named.size() > 1) {
    verdict.kind = Verdict::Kind::kAmbiguous;
    verdict.numbers = std::all_of(verdict.named.begin(), verdict.named.end(),
                                  [&](std::size_t i) { return all.of(i).corrects; });
    verdict.reason =
        fmt::format("the likelihoods of {} candidates are {}", verdict.named.size(), near);
  } else if (verdict.unlisted.empty() && far_off.empty()) {
    verdict.reason = fmt::format(
        "{}, and the next candidate is {:.1f} behind in 2 ln L, less {:g} for each parameter",
        shows, all.Lead(best), +criteria.parameter_cost);
  } else {
    verdict.reason = shows;
  }
  if (!unlisted.empty())
    verdict.reason += fmt::format("; not listed, but as likely ({}): {}", near, unlisted);
  if (!far_off.empty()) verdict.reason += "; as likely, but of no plausible size: " + far_off;
  return verdict;
}

Verdict Unexplained(std::string reason) {
  return {Verdict::Kind::kUnexplained, {}, std::move(reason)};
}

Verdict ExplainedBy(const LikelihoodRecord& unlisted, std::string reason) {
  Verdict verdict = Unexplained(std::move(reason));
  verdict.explained_by = unlisted.name;
  return verdict;
}

}  // namespace

Kin KinOf(std::string_view effect) {
  const Kinship& kin = EffectNamed(effect).kin;
  return {std::string(kin.family), kin.depth};
}

std::string FamilyOf(std::string_view effect) {
  const Kin kin = KinOf(effect);
  return kin.family.empty() ? std::string(effect) : kin.family;
}

Kin KinOf(std::string_view effect, std::string_view other) {
  const std::string a = FamilyOf(effect), b = FamilyOf(other);
  return {std::min(a, b) + " and " + std::max(a, b), KinOf(effect).depth + KinOf(other).depth};
}

Verdict Verdict::Adequate(std::string reason) {
  Verdict verdict{Kind::kAdequate, {}, std::move(reason)};
  verdict.complete = true;
  return verdict;
}

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

double ScoreOf(const LikelihoodRecord& record, const Criteria& criteria, double scale) {
  const double extra = static_cast<double>(record.parameters) - 1;
  return record.likelihood - scale * criteria.parameter_cost * extra;
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

double ShareOf(const LikelihoodRecord& record, const BaseSquares& base) {
  const double above = base.squares - base.freedom;
  const double share = above > 0 ? record.likelihood / above : 1;
  return std::clamp(std::min(share, record.error_share), 0.0, 1.0);
}

Verdict JudgeLikelihoods(const std::vector<LikelihoodRecord>& candidates, const LackOfFit& lack,
                         double p, const BaseSquares& base, const Criteria& criteria) {
  // First order may promise what no fit keeps.
  const bool kept = std::any_of(candidates.begin(), candidates.end(), [&](const auto& c) {
    return c.listed && ScoreOf(c, criteria) > criteria.parameter_cost;
  });
  const bool any = p < criteria.significance && kept;
  const bool more = lack.significant(criteria) && !lack.of_step;
  if (!any && more)
    return Unexplained("the residual shows something beside noise that no candidate explains");
  if (!any) return Adequate(lack, p, criteria);
  const Ranking all(candidates, base, more, criteria);
  const std::size_t best = all.BestNotFarOff();
  const bool main = !more || all.share(all.first()) >= criteria.main_share;
  Verdict verdict;
  if (const LikelihoodRecord* const other = all.Outdoing(best, main)) {
    verdict = ExplainedBy(
        *other, fmt::format("the best candidate, {}, is clearly outdone by {}, which is not listed",
                            all.of(best).name, other->name));
  } else if (!main) {
    verdict = Unexplained(fmt::format(
        "the best candidate, {}, explains {} of what noise does not, and {:.0f} % are asked "
        "for: another cause is at work, or one more",
        all.of(all.first()).name, Percent(all.share(all.first())), 100 * criteria.main_share));
  } else if (const LikelihoodRecord* const plainer = all.SayingTheSame(best)) {
    verdict = ExplainedBy(
        *plainer,
        fmt::format(
            "{}, which is not listed, says in fewer numbers what the best candidate, {}, does",
            plainer->name, all.of(best).name));
  } else {
    verdict = Name(all, best, lack, more, criteria);
  }
  verdict.leading = best, verdict.leading_share = all.share(best);
  return verdict;
}

std::optional<Verdict> NameByError(const std::vector<LikelihoodRecord>& candidates,
                                   const Criteria& criteria) {
  Verdict verdict{Verdict::Kind::kNamed};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const LikelihoodRecord& one = candidates[i];
    if (!one.listed || one.error_share < 1 - criteria.second_share ||
        ScoreOf(one, criteria) < criteria.separation)
      continue;
    const bool kin = !verdict.named.empty() && one.kin.Of(candidates[verdict.named.front()].kin);
    (kin ? verdict.siblings : verdict.named).push_back(i);
  }
  if (verdict.named.empty()) return {};
  if (verdict.named.size() > 1) verdict.kind = Verdict::Kind::kAmbiguous;
  const LikelihoodRecord& best = candidates[verdict.named.front()];
  verdict.leading = verdict.named.front(), verdict.leading_share = best.error_share;
  verdict.reason = fmt::format(
      "{} takes {:.0f} % of the error that noise does not make, and its residual shows more than "
      "noise",
      best.name, 100 * best.error_share);
  return verdict;
}

}  // namespace continuum
