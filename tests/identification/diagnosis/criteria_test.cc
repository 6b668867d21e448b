#include "identification/diagnosis/criteria.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/diagnosis/correction.h"
#include "identification/diagnosis/fallback_force.h"
#include "identification/diagnosis/free_lengths.h"
#include "identification/diagnosis/screening.h"
#include "identification/diagnosis/search_rules.h"
#include "identification/diagnosis/verdict.h"

namespace continuum {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

// What is judged, as text, under some rules.
using Judged = std::function<std::string(const Criteria&)>;

constexpr double kBelow = 0.7, kAbove = 1.4;  // times a rule: its half and its double are past them

std::string Text(bool value) { return value ? "yes" : "no"; }
std::string Text(double value) { return fmt::format("{:.6g}", value); }

// A decision on one number, on both sides of a boundary that is proportional to a rule.
template <typename Decide>
std::vector<Judged> AroundBoundary(double boundary, const Decide& decide) {
  std::vector<Judged> judged;
  for (const double factor : {kBelow, kAbove}) {
    const double x = factor * boundary;
    judged.push_back([=](const Criteria& c) { return Text(decide(x, c)); });
  }
  return judged;
}
// A number that a rule moves.
template <typename Value>
std::vector<Judged> Number(const Value& value) {
  return {[=](const Criteria& c) { return Text(value(c)); }};
}

// Ten folds with a gain in each, a steady size and no placebos.
FoldRecord Folds(double after, double over_noise = 1) {
  FoldRecord r;
  r.name = "cause";
  r.before.assign(10, 1.0);
  for (int f = 0; f < 10; ++f) r.after.push_back(after + 0.001 * (f % 2));
  r.amplitude.assign(10, 1.0);
  r.over_noise = over_noise;
  return r;
}
// The first folds are better, the others worse.
FoldRecord BetterIn(int folds) {
  FoldRecord r = Folds(0.5);
  for (int f = folds; f < 10; ++f) r.after[f] = 1.5;
  return r;
}
std::string FailuresOf(const FoldRecord& r, const Criteria& c) {
  std::string text;
  for (const auto& failure : Failures(r, c)) text += failure + "; ";
  return text;
}
std::string KindOf(const std::vector<FoldRecord>& records, const ErrorLevel& error,
                   const Criteria& c) {
  return JudgeFolds(records, error, c).word();
}
constexpr ErrorLevel kKnown{.over_noise = 20, .ceiling_gain = 0.9};

std::vector<Judged> FoldsBetter() {
  std::vector<Judged> judged;
  for (const int better : {5, 8, 9})
    judged.push_back([=](const Criteria& c) { return FailuresOf(BetterIn(better), c); });
  return judged;
}
std::vector<Judged> PlaceboShare() {
  std::vector<Judged> judged;
  for (const int beaten : {13, 20}) {
    FoldRecord r = Folds(0.5);
    r.placebo_gains.assign(20, 0.9);
    std::fill_n(r.placebo_gains.begin(), beaten, 0.1);
    judged.push_back([=](const Criteria& c) { return FailuresOf(r, c); });
  }
  return judged;
}
std::vector<Judged> RivalGain() {
  std::vector<Judged> judged;
  for (const double share :
       {0.3, 0.8}) {  // of the best one's gain; too erratic to be clearly worse
    FoldRecord rival = Folds(1 - 0.8 * share);
    for (const int f : {0, 1, 2}) rival.after[f] = 0;
    judged.push_back([=](const Criteria& c) { return KindOf({Folds(0.2), rival}, kKnown, c); });
  }
  return judged;
}
std::vector<Judged> LeastFolds() {
  std::vector<Judged> judged;
  for (const std::size_t folds : {1, 3}) {
    FoldRecord r = Folds(0.5);
    r.before.resize(folds), r.after.resize(folds), r.amplitude.resize(folds);
    judged.push_back([=](const Criteria& c) { return FailuresOf(r, c); });
  }
  return judged;
}

// A named cause whose likelihood the runner-up falls behind by some amount.
Judged Lead(double lead, std::size_t parameters = 1, std::vector<std::size_t> contains = {},
            double step = 0) {
  return [=](const Criteria& c) {
    const LikelihoodRecord plain{"plain", 1, 500, {}, step};
    const LikelihoodRecord rich{"rich", parameters, 500 + lead, contains, step};
    const Verdict v = JudgeLikelihoods({plain, rich}, {}, 1e-3, {}, c);
    return v.word() + fmt::format(" {}", fmt::join(v.named, ","));
  };
}
// A model with 100 squares of noise, and two causes of other families that leave so many squares
// above that.
constexpr double kNoise = 100;
Judged TwoThatLeave(double squares, double best, double rival) {
  return [=](const Criteria& c) {
    const double before = kNoise + squares;
    return JudgeLikelihoods({{"best", 1, squares - best}, {"rival", 1, squares - rival}}, {1e-9},
                            1e-3, {before, kNoise}, c)
        .word();
  };
}
std::vector<Judged> Left() {
  return {TwoThatLeave(4000, 800, 800 + 160 * kBelow), TwoThatLeave(4000, 800, 800 + 160 * kAbove)};
}
std::vector<Judged> Structure() {
  const double most = 1e6;
  return {TwoThatLeave(most, 1, 1 + 2000 * kBelow), TwoThatLeave(most, 1, 1 + 2000 * kAbove)};
}
std::vector<Judged> LeastStructure() {
  std::vector<Judged> judged;
  for (const double lead : {100 * kBelow, 100 * kAbove}) {
    judged.push_back([=](const Criteria& c) {
      return JudgeLikelihoods({{"best", 1, 1e6}, {"rival", 1, 1e6 - lead}}, {}, 1e-3, {}, c).word();
    });
  }
  return judged;
}
std::vector<Judged> MainShare() {
  std::vector<Judged> judged;
  for (const double share : {0.5, 0.8}) {
    judged.push_back([=](const Criteria& c) {
      LikelihoodRecord cause{"cause", 1, share * 1000};
      cause.error_share = share;
      return JudgeLikelihoods({cause}, {1e-9}, 1e-3, {1000 + kNoise, kNoise}, c).word();
    });
  }
  return judged;
}

std::vector<Judged> FamilyShare() {
  std::vector<Judged> judged;
  for (const double share : {0.6, 0.97}) {
    judged.push_back([=](const Criteria& c) {
      LikelihoodRecord plain{"plain", 1, share * 1000}, rich{"rich", 1, 1000};
      plain.kin = {"dry friction", 0}, rich.kin = {"dry friction", 1};
      return fmt::format("{}", JudgeLikelihoods({plain, rich}, {}, 1e-3, {}, c).named.front());
    });
  }
  return judged;
}

std::vector<Judged> EarnedShare() {
  std::vector<Judged> judged;
  for (const double share : {0.93, 0.85}) {
    judged.push_back([=](const Criteria& c) {
      LikelihoodRecord plain{"plain", 1, 960}, rich{"rich", 2, 1000, {0}};
      plain.held_out = 1, rich.held_out = share;
      const auto v = JudgeLikelihoods({plain, rich}, {1e-6}, 1e-3, {1100, 100}, c);
      return fmt::format("{}", v.named.front());
    });
  }
  return judged;
}

std::vector<Judged> LackLevel() {
  std::vector<Judged> judged;
  for (const double factor : {kBelow, kAbove}) {
    judged.push_back([=](const Criteria& c) {
      return Text(JudgeLikelihoods({{"cause", 1, 100}}, {0.002 * factor}, 1e-3, {}, c).complete);
    });
  }
  return judged;
}

// Residuals of one parameter, with a time-discretisation error of some size along the residual and
// of some deviation from first order, and a delay across it.
ProjectedResidual Residual(double size, double step, double deviation, const Criteria& c) {
  Eigen::VectorXd r = Eigen::VectorXd::Zero(50);
  r[0] = size, r[2] = 0.4 * size;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(50, 1), S = Eigen::MatrixXd::Zero(50, 3);
  J(49, 0) = 1;
  S(0, 0) = step, S(2, 1) = step, S(1, 2) = deviation;
  return {Whitening(), {true}, {r}, {J}, {false}, {S}, c};
}
std::vector<Judged> Roughness(double deviation) {
  return Number([=](const Criteria& c) { return Residual(1, 1, deviation, c).roughness(); });
}
std::vector<Judged> Cost(double size, double step) {
  return Number([=](const Criteria& c) { return Residual(size, step, 0.1, c).cost(); });
}

const Verdict kUnexplained{Verdict::Kind::kUnexplained};

// Judged examples of each rule that needs no simulation.
std::map<std::string, std::vector<Judged>> Examples() {
  std::map<std::string, std::vector<Judged>> e;
  e["folds_better"] = FoldsBetter();
  e["median_gain"] = AroundBoundary(
      0.10, [](double gain, const Criteria& c) { return HelpsOnFolds(Folds(1 - gain), c); });
  e["fit_gain"] = AroundBoundary(
      0.05, [](double gain, const Criteria& c) { return WorthFolds(1, 1 - gain, c); });
  e["amplitude_spread"] = AroundBoundary(0.3, [](double spread, const Criteria& c) {
    FoldRecord r = Folds(0.5);
    r.amplitude[0] = 1 + spread;
    return Failures(r, c).empty();
  });
  e["placebo_share"] = PlaceboShare();
  e["fold_margin"] = AroundBoundary(0.05, [](double margin, const Criteria& c) {
    return JudgeFolds({Folds(0.5 * (1 - margin)), Folds(0.5)}, kKnown, c).named.size() == 1;
  });
  e["rival_gain"] = RivalGain();
  e["least_folds"] = LeastFolds();
  e["at_noise"] = AroundBoundary(1.1, [](double over, const Criteria& c) {
    return JudgeFolds({}, {over}, c).kind == Verdict::Kind::kAdequate;
  });
  e["fold_share"] = AroundBoundary(0.5, [](double squares, const Criteria& c) {
    const ErrorLevel known{.over_noise = 1e6, .ceiling_gain = 0.9, .by_replicates = true};
    return KindOf({Folds(std::sqrt(1 - squares))}, known, c) == "named";
  });
  e["near_noise"] = AroundBoundary(1.25, [](double over, const Criteria& c) {
    return JudgeFolds({Folds(0.5, over)}, kKnown, c).complete;
  });
  e["model_limited"] = AroundBoundary(
      3, [](double over, const Criteria& c) { return HasSignal(1, over * over * 100, 100, c); });
  e["scatter_limit"] = AroundBoundary(10, [](double over, const Criteria& c) {
    return JudgeFolds({}, {0, 0, over}, c).kind == Verdict::Kind::kUnexplained;
  });
  e["significance"] = AroundBoundary(0.045, [](double p, const Criteria& c) {
    return JudgeLikelihoods({{"cause", 1, 100}}, {}, p, {}, c).named.size() == 1;
  });
  e["lack_of_fit"] = LackLevel();
  e["parameter_cost"] = AroundBoundary(3.84, [](double likelihood, const Criteria& c) {
    return JudgeLikelihoods({{"cause", 1, likelihood}}, {}, 1e-3, {}, c).named.size() == 1;
  });
  e["rival_margin"] = {Lead(5 * kBelow), Lead(5 * kAbove)};
  e["nested_margin"] = {Lead(3.84 + 2.8 * kBelow, 2, {0}), Lead(3.84 + 2.8 * kAbove, 2, {0})};
  e["left_share"] = Left();
  e["structure_share"] = Structure();
  e["structure_least"] = LeastStructure();
  e["main_share"] = MainShare();
  e["family_share"] = FamilyShare();
  e["plainly_more"] = AroundBoundary(2, [](double held_out, const Criteria& c) {
    LikelihoodRecord plain{"plain", 1, 970}, rich{"rich", 1, 1000};
    plain.kin = {"dry friction", 0}, rich.kin = {"dry friction", 1};
    plain.held_out = held_out, rich.held_out = 1;
    return JudgeLikelihoods({plain, rich}, {}, 1e-3, {.floor = 1}, c).named.front() == 1;
  });
  e["earned_share"] = EarnedShare();
  e["step_share"] = {Lead(50 * kBelow, 1, {}, 10'000), Lead(50 * kAbove, 1, {}, 10'000)};
  e["plain_noise"] = AroundBoundary(0.05, [](double p, const Criteria& c) {
    return ResidualInWords({p}, c) == "nothing but noise";
  });
  e["step_seen"] = AroundBoundary(
      15, [](double step, const Criteria& c) { return ExplainedByStep(100, 100, step, c); });
  e["step_tolerance"] = AroundBoundary(1.25 * 1.25, [](double share, const Criteria& c) {
    return ExplainedByStep(100 + 50 * share, 100, 50, c);
  });
  e["step_falls"] = AroundBoundary(
      0.75, [](double share, const Criteria& c) { return FallsWithStep(1, share, c); });
  e["step_rough"] = AroundBoundary(
      0.15, [](double roughness, const Criteria& c) { return IsRough(roughness, c); });
  e["step_resolved"] = AroundBoundary(
      0.1, [](double step, const Criteria& c) { return IsResolved(step, 0, 0, 1, c); });
  e["step_varies"] = Roughness(0.1);
  e["step_least_spread"] = Roughness(0.0);
  e["step_most_spread"] = Roughness(100);
  e["step_farthest"] = Cost(10, 1);
  e["late"] = Cost(3, 1);
  e["probe_far"] = AroundBoundary(
      5, [](double norm, const Criteria& c) { return SmallerShare(norm, 1, c) < 1; });
  e["probe_least"] = Number([](const Criteria& c) { return ProbeTarget(100, 99, true, c); });
  e["start_share"] = AroundBoundary(
      0.05, [](double explained, const Criteria& c) { return StartShare(explained, 1, c); });
  e["as_good"] = AroundBoundary(
      0.99, [](double explained, const Criteria& c) { return IsAsGood(explained, 1, c); });
  e["contained"] =
      AroundBoundary(0.01, [](double missed, const Criteria& c) { return Contains(missed, 1, c); });
  e["same_noise"] = AroundBoundary(10, [](double difference, const Criteria& c) {
    return SaysTheSame({0, difference, 100}, true, c);
  });
  e["same_gain"] = AroundBoundary(30, [](double gain, const Criteria& c) {
    return SaysTheSame({gain, 1, 100}, true, c);
  });
  e["same_share"] = AroundBoundary(2, [](double difference, const Criteria& c) {
    return SaysTheSame({0, difference, 100}, false, c);
  });
  e["worth_a_fit"] = Number([](const Criteria& c) { return FitThreshold(10, 100, false, c); });
  e["fit_behind"] = Number([](const Criteria& c) { return FitThreshold(40, 100, true, c); });
  e["fit_always"] = Number([](const Criteria& c) { return FitThreshold(500, 1000, true, c); });
  e["fit_share"] = Number([](const Criteria& c) { return FitThreshold(10'000, 1e5, true, c); });
  e["force_least"] = AroundBoundary(
      0.05, [](double share, const Criteria& c) { return ExplainsForce(share, 0, c); });
  e["force_share"] = AroundBoundary(
      0.5, [](double share, const Criteria& c) { return ExplainsForce(share, 1, c); });
  e["rival_share"] = Number([](const Criteria& c) { return UnlistedThreshold(100, c); });
  e["unseen"] = AroundBoundary(500, [](double unseen, const Criteria& c) {
    return TooManyUnseen(static_cast<std::size_t>(unseen), 2000, c);
  });
  e["outdoes"] = AroundBoundary(
      10, [](double explained, const Criteria& c) { return WorthFinishing(0, explained, 100, c); });
  e["hopeless_factor"] = Number([](const Criteria& c) { return HopelessCost(1000, c); });
  e["hopeless_offset"] = Number([](const Criteria& c) { return HopelessCost(0, c); });
  e["kept_share"] = AroundBoundary(
      50, [](double kept, const Criteria& c) { return GainKept(100, kept, -1e6, c) > 99; });
  e["completed_within"] = AroundBoundary(
      50, [](double behind, const Criteria& c) { return WorthCompleting(behind, 0, 0, c); });
  e["still_gains"] = AroundBoundary(
      0.5, [](double gain, const Criteria& c) { return StillGains(gain, 1, true, c); });
  e["still_gains_share"] = AroundBoundary(
      1e-3, [](double gain, const Criteria& c) { return StillGains(gain, 1, false, c); });
  e["second_chances"] = AroundBoundary(6, [](double finished, const Criteria& c) {
    return WorthFinishing(static_cast<std::size_t>(finished), 100, 100, c);
  });
  e["fits_in_vain"] = AroundBoundary(8, [](double fits, const Criteria& c) {
    return GoOnInVain(static_cast<std::size_t>(fits), c);
  });
  e["second_share"] = AroundBoundary(0.05, [](double left, const Criteria& c) {
    Verdict named{Verdict::Kind::kNamed};
    named.leading_share = 1 - left;
    return MayBeTwo(named, {}, 1e-3, 1, c);
  });
  e["rest_noise"] = AroundBoundary(2, [](double over, const Criteria& c) {
    Verdict named{Verdict::Kind::kNamed};
    named.leading_share = 1;
    return MayBeTwo(named, {}, 1e-3, over, c);
  });
  e["correction"] = Number(
      [](const Criteria& c) { return MayBeOff(EffectNamed("input_gain"), "gain", 1, {}, c); });
  e["whole_correction"] =
      Number([](const Criteria& c) { return MayBeOff(EffectNamed("payload"), "mass", 0, {}, c); });
  e["numbers_most"] = AroundBoundary(0.02, [](double off, const Criteria& c) {
    return AreNumbersEnough({100, off, 2}, 100, 50, c);
  });
  e["numbers_share"] = AroundBoundary(95, [](double squares, const Criteria& c) {
    return AreNumbersEnough({squares, 0.01, 2}, 100, 50, c);
  });
  e["correction_share"] = AroundBoundary(0.5, [](double share, const Criteria& c) {
    return MayBeLengthsAndMasses({share * 100, 0.01, 2}, 100, c);
  });
  e["lengths_off"] = Number([](const Criteria& c) {
    Hypothesis link{"link_length", "", "body arm", ModelSpec::Parse("<mujoco/>"), {}, {}, "", {}};
    link.extra.emplace_back();
    return FreeLength(link, c).upper;
  });
  e["lengths_gain"] =
      AroundBoundary(0.5, [](double error, const Criteria& c) { return IsFarLess(error, 1, c); });
  e["factor_most"] =
      AroundBoundary(2, [](double factor, const Criteria& c) { return IsFarOff(factor, c); });
  e["clock_most"] =
      AroundBoundary(0.02, [](double skew, const Criteria& c) { return IsFarClock(skew, c); });
  e["tilt_most"] =
      AroundBoundary(0.25, [](double tilt, const Criteria& c) { return IsFarTilt(tilt, c); });
  e["pair_hopeless"] = AroundBoundary(100, [](double over, const Criteria& c) {
    return MayBeTwo(kUnexplained, {}, 1e-3, over, c);
  });
  e["pair_share"] = AroundBoundary(
      0.5, [](double share, const Criteria& c) { return WorthPartner(1e-3, share, true, c); });
  e["pair_plain"] = AroundBoundary(
      0.5, [](double plain, const Criteria& c) { return MayDoBesideAnother(plain, 1, c); });
  e["fallback_ceiling"] = AroundBoundary(
      0.05, [](double gain, const Criteria& c) { return WorthFallback(gain, false, c); });
  e["fallback_size"] =
      Number([](const Criteria& c) { return FallbackLaw(3, Sizes{}, c).parameters.front().upper; });
  e["separation"] =
      AroundBoundary(15, [](double lambda, const Criteria& c) { return Distinguishes(lambda, c); });
  return e;
}

// How many of something a search tries: what changes with them needs a whole diagnosis.
const std::set<std::string> kOnlyInSearches{"fresh_starts", "link_known", "pair_singles",
                                            "pair_bases", "next_rivals"};

std::vector<std::string> JudgedBy(const std::vector<Judged>& examples, const Criteria& criteria) {
  std::vector<std::string> out;
  for (const Judged& one : examples) out.push_back(one(criteria));
  return out;
}

TEST(Criteria, HalfOrTwiceAnyRuleChangesAJudgement) {
  const auto examples = Examples();
  for (const auto rule : kAllRules) {
    const std::string name((Criteria{}.*rule).name);
    if (kOnlyInSearches.contains(name)) continue;
    ASSERT_TRUE(examples.contains(name)) << name;
    const auto before = JudgedBy(examples.at(name), {});
    for (const double factor : {0.5, 2.0}) {
      Criteria other;
      (other.*rule).value *= factor;
      EXPECT_NE(JudgedBy(examples.at(name), other), before) << name << " times " << factor;
    }
  }
}

TEST(Criteria, EveryExampleIsOfARule) {
  std::set<std::string> names;
  for (const auto rule : kAllRules) names.emplace((Criteria{}.*rule).name);
  EXPECT_EQ(names.size(), kAllRules.size());
  for (const auto& [name, judged] : Examples()) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Criteria, EveryRuleHasAUnitAndAReason) {
  for (const auto member : kAllRules) {
    const Rule rule = Criteria{}.*member;
    EXPECT_THAT(rule.unit, Not(IsEmpty())) << rule.name;
    EXPECT_THAT(rule.reason, Not(IsEmpty())) << rule.name;
  }
}

}  // namespace
}  // namespace continuum
