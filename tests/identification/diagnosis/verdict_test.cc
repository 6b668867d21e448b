#include "identification/diagnosis/verdict.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::Contains;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

// Ten folds, halved by the candidate with a steady size, above all of twenty placebos.
FoldRecord Good() {
  FoldRecord r;
  r.name = "good";
  r.before.assign(10, 1.0);
  r.after = {0.50, 0.52, 0.48, 0.51, 0.49, 0.50, 0.52, 0.48, 0.51, 0.49};
  r.amplitude.assign(10, 2.0);
  r.placebo_gains.assign(20, 0.05);
  r.over_noise = 1.0;
  return r;
}

// Worse than Good in every fold, by more than their scatter.
FoldRecord RunnerUp() {
  FoldRecord r = Good();
  r.name = "runner-up";
  for (double& a : r.after) a += 0.1;
  return r;
}

// Only noise is left, whatever was explained: nothing is known of the model before.
constexpr BaseSquares kCalibrated{};

// The present error is ten times the noise: there is something to explain.
constexpr ErrorLevel kKnown{.over_noise = 10, .ceiling_gain = 0.9};

std::string TextOf(const FoldRecord& r) { return JudgeFolds({r}, kKnown).word(); }

TEST(Gains, AreTheRelativeFallOfTheErrorPerFold) {
  FoldRecord r;
  r.before = {2, 4, 0};
  r.after = {1, 5, 1};
  EXPECT_THAT(Gains(r), ElementsAre(DoubleNear(0.5, 1e-15), DoubleNear(-0.25, 1e-15), 0));
}

TEST(Median, TakesTheMiddleWhateverTheOrder) {
  EXPECT_EQ(Median({3, 1, 2}), 2);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(Median({}), 0);
}

TEST(Failures, AreNoneForARecordThatMeetsEveryRule) {
  EXPECT_THAT(Failures(Good()), IsEmpty());
  EXPECT_EQ(TextOf(Good()), "named");
}

TEST(Failures, AllowTwoWorseFoldsOfTenButNotThree) {
  FoldRecord r = Good();
  r.after[0] = r.after[1] = 1.01;
  EXPECT_THAT(Failures(r), IsEmpty());
  r.after[2] = 1.01;
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("only 7 of 10 folds")));
  EXPECT_EQ(TextOf(r), "unexplained");
}

TEST(Failures, OneWorseFoldOfFourIsTooMany) {
  FoldRecord r = Good();
  r.before.resize(4), r.after.resize(4), r.amplitude.resize(4);
  EXPECT_THAT(Failures(r), IsEmpty());
  r.after[3] = 1.01;
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("only 3 of 4 folds")));
}

TEST(Failures, AnUnchangedFoldDoesNotCountAsBetter) {
  FoldRecord r = Good();
  r.after[0] = r.after[1] = r.after[2] = 1.0;
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("only 7 of 10 folds")));
}

TEST(Failures, AskForATenthOfTheErrorInTheMedian) {
  FoldRecord r = Good();
  r.placebo_gains.assign(20, 0.01);
  r.after.assign(10, 0.89);
  EXPECT_THAT(Failures(r), IsEmpty());
  r.after.assign(10, 0.91);
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("falls by 9.0 % in the median")));
  EXPECT_EQ(TextOf(r), "unexplained");
}

TEST(Failures, OneOtherSignOfTheAmplitudeIsEnough) {
  FoldRecord r = Good();
  r.amplitude[4] = -2;
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("size varies")));
  EXPECT_EQ(TextOf(r), "unexplained");
}

TEST(Failures, TheAmplitudeMayVaryByThirtyPercentEitherWay) {
  for (const double a : {1.42, 2.58}) {
    FoldRecord r = Good();
    r.amplitude[0] = a;
    EXPECT_THAT(Failures(r), IsEmpty()) << a;
  }
  for (const double a : {1.38, 2.62}) {
    FoldRecord r = Good();
    r.amplitude[0] = a;
    EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("size varies"))) << a;
  }
}

TEST(Failures, ANegativeAmplitudeMayBeSteadyToo) {
  FoldRecord r = Good();
  for (double& a : r.amplitude) a = -a;
  EXPECT_THAT(Failures(r), IsEmpty());
}

TEST(Failures, AnAmplitudeOfZeroIsNoCause) {
  FoldRecord r = Good();
  r.amplitude.assign(10, 0.0);
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("size varies")));
}

TEST(Failures, OnePlaceboOfTwentyMayBeBetterButNotTwo) {
  FoldRecord r = Good();
  r.placebo_gains[0] = 0.9;
  EXPECT_THAT(Failures(r), IsEmpty());
  r.placebo_gains[1] = 0.9;
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("18 of 20 random")));
  EXPECT_EQ(TextOf(r), "unexplained");
}

TEST(Failures, APlaceboAsGoodIsNotBeaten) {
  FoldRecord r = Good();
  r.after.assign(10, 0.5);
  r.placebo_gains.assign(20, 0.5);
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("0 of 20 random")));
}

TEST(Failures, OneFoldIsNoCrossValidation) {
  FoldRecord r = Good();
  r.before.resize(1), r.after.resize(1), r.amplitude.resize(1);
  EXPECT_THAT(Failures(r), ElementsAre(HasSubstr("two folds")));
}

TEST(Failures, NumbersThatAreNoneNeverPass) {
  FoldRecord r = Good();
  r.after.assign(10, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(Failures(r), Contains(HasSubstr("in the median")));
  r = Good();
  r.amplitude[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Failures(r).empty());
}

TEST(ClearlyBetter, NeedsMoreThanOneStandardErrorOfThePairedDifference) {
  FoldRecord a = Good(), b = Good();
  // Differences d ± s alternating over ten folds: standard error s sqrt(10/9)/sqrt(10) = s/3.
  const auto shift = [&](double d, double s) {
    b.after = a.after;
    for (std::size_t f = 0; f < 10; ++f) b.after[f] += f % 2 ? d + s : d - s;
  };
  shift(0.034, 0.1);
  EXPECT_FALSE(ClearlyBetter(a, b));  // five wins of ten
  b.after[0] += 0.2, b.after[2] += 0.2;
  EXPECT_FALSE(ClearlyBetter(a, b));  // seven
  b.after[4] += 0.2;
  EXPECT_TRUE(ClearlyBetter(a, b));  // eight
  EXPECT_FALSE(ClearlyBetter(b, a));
  shift(0.1, 0.05);
  EXPECT_TRUE(ClearlyBetter(a, b));
}

TEST(ClearlyBetter, AMajorityOfFoldsIsNotEnough) {
  const FoldRecord a = Good();
  FoldRecord b = Good();
  // Mean 0.04, standard error 0.065.
  for (std::size_t f = 0; f < 10; ++f) b.after[f] = a.after[f] + (f < 6 ? 0.2 : -0.2);
  EXPECT_FALSE(ClearlyBetter(a, b));
}

TEST(ClearlyBetter, OneHugeFoldIsNotEnough) {
  const FoldRecord a = Good();
  FoldRecord b = Good();
  for (double& y : b.after) y -= 0.001;
  b.after[0] = 5;
  EXPECT_FALSE(ClearlyBetter(a, b));
}

TEST(ClearlyBetter, WeighsFoldsByTheirOwnError) {
  FoldRecord a = Good(), b = RunnerUp();
  a.before[0] = b.before[0] = 1e3;
  a.after[0] = 560;  // a fold in other units, slightly for b
  b.after[0] = 550;
  EXPECT_TRUE(ClearlyBetter(a, b));
}

TEST(ClearlyBetter, IsNeverSoForEquals) { EXPECT_FALSE(ClearlyBetter(Good(), Good())); }

TEST(Judge, NamesTheBestOfTwoThatTheFoldsDistinguish) {
  for (const bool first : {true, false}) {
    const auto records = first ? std::vector{Good(), RunnerUp()} : std::vector{RunnerUp(), Good()};
    const Verdict v = JudgeFolds(records, kKnown);
    EXPECT_EQ(v.word(), "named");
    EXPECT_THAT(v.named, ElementsAre(first ? 0 : 1));
  }
}

TEST(Judge, AnEqualRunnerUpMakesItAmbiguous) {
  FoldRecord twin = Good();
  std::swap(twin.after[0], twin.after[1]);
  const Verdict v = JudgeFolds({Good(), RunnerUp(), twin}, kKnown);
  EXPECT_EQ(v.word(), "ambiguous");
  EXPECT_THAT(v.named, UnorderedElementsAre(0, 2));
}

TEST(Judge, ARivalThatFailsARuleStillStandsInTheWayOfAName) {
  FoldRecord rival = Good();
  rival.amplitude[0] = -2;
  EXPECT_EQ(JudgeFolds({Good(), rival}, kKnown).word(), "ambiguous");
}

TEST(Judge, OneWithLessThanHalfTheGainIsNoRival) {
  FoldRecord erratic = Good();
  for (std::size_t f = 0; f < 10; ++f) erratic.after[f] = f < 4 ? 0 : 0.99;
  ASSERT_FALSE(ClearlyBetter(Good(), erratic));
  EXPECT_EQ(JudgeFolds({Good(), erratic}, kKnown).word(), "named");
}

TEST(Judge, WhatIsLeftTakesNoNameAwayButIsSaid) {
  for (const double over : {1.2, 2.0, 40.0}) {
    FoldRecord r = Good();
    r.over_noise = over;
    const Verdict v = JudgeFolds({r}, kKnown);
    EXPECT_EQ(v.word(), "named") << over;
    EXPECT_EQ(v.complete, over < 1.25) << over;
    EXPECT_EQ(v.leading, 0u);
  }
}

TEST(Judge, OfAFamilyThePlainestThatIsNotClearlyWorseIsNamed) {
  FoldRecord plain = Good(), rich = Good();
  plain.kin = {"friction", 0}, rich.kin = {"friction", 1};
  for (double& a : rich.after) a -= 0.005;
  const Verdict v = JudgeFolds({rich, plain}, kKnown);
  EXPECT_EQ(v.word(), "named");
  EXPECT_THAT(v.named, ElementsAre(1));
  EXPECT_THAT(v.siblings, ElementsAre(0));
}

TEST(Judge, ARichLawThatIsClearlyBetterIsNamed) {
  FoldRecord plain = Good(), rich = Good();
  plain.kin = {"friction", 0}, rich.kin = {"friction", 1};
  for (double& a : rich.after) a -= 0.3;
  const Verdict v = JudgeFolds({rich, plain}, kKnown);
  EXPECT_THAT(v.named, ElementsAre(0));
}

TEST(Judge, WhereNothingPassesItSaysWhatComesClosest) {
  FoldRecord r = Good();
  r.amplitude[0] = -2;
  const Verdict v = JudgeFolds({r}, kKnown);
  EXPECT_EQ(v.word(), "unexplained");
  EXPECT_EQ(v.leading, 0u);
  EXPECT_GT(v.leading_share, 0.5);
}

TEST(HoldsOnFolds, AsksForHalfOfWhatNoiseLeavesOpen) {
  FoldRecord r = Good();
  r.after.assign(10, 0.97);
  EXPECT_FALSE(HoldsOnFolds(r, 0.5));
  EXPECT_TRUE(HoldsOnFolds(r, 0.05));
  r.after[0] = r.after[1] = r.after[2] = 1.01;
  EXPECT_FALSE(HoldsOnFolds(r, 0.05));
}

TEST(Judge, IsAdequateAtTheNoiseWhateverTheCandidatesSay) {
  const Verdict v = JudgeFolds({Good()}, {1.05, 0.9});
  EXPECT_EQ(v.word(), "adequate");
  EXPECT_THAT(v.named, IsEmpty());
  EXPECT_EQ(JudgeFolds({Good()}, {1.15, 0.9}).word(), "named");
}

TEST(Judge, WithoutNoiseItIsAdequateOnlyWhenNoForceHelps) {
  FoldRecord bad = Good();
  bad.after = bad.before;
  EXPECT_EQ(JudgeFolds({bad}, {0, 0.05}).word(), "adequate");
  EXPECT_EQ(JudgeFolds({bad}, {0, 0.15}).word(), "unexplained");
  EXPECT_EQ(JudgeFolds({bad}, {0, 0.05, 70}).word(), "unexplained");
  EXPECT_EQ(JudgeFolds({bad}, {10, 0.05}).word(), "unexplained");
  EXPECT_EQ(JudgeFolds({Good()}, {0, 0.05}).word(), "named");
}

TEST(Judge, IsUnexplainedWithoutCandidates) {
  const Verdict v = JudgeFolds({}, kKnown);
  EXPECT_EQ(v.word(), "unexplained");
  EXPECT_THAT(v.named, IsEmpty());
  EXPECT_FALSE(v.reason.empty());
}

TEST(Likelihoods, NothingSignificantIsAdequateUnlessSomethingElseIsLeft) {
  const std::vector<LikelihoodRecord> none;
  EXPECT_EQ(JudgeLikelihoods(none, {0.5}, 0.3, kCalibrated).word(), "adequate");
  EXPECT_EQ(JudgeLikelihoods(none, {1e-4}, 0.3, kCalibrated).word(), "unexplained");
}

TEST(JudgeLikelihoods, NothingIsNamedThatNoFitConfirms) {
  EXPECT_EQ(JudgeLikelihoods({{"a", 1, 3}, {"b", 2, 7}}, {0.5}, 1e-3, kCalibrated).word(),
            "adequate");
  EXPECT_EQ(JudgeLikelihoods({{"a", 1, 3}, {"b", 2, 7}}, {1e-4}, 1e-3, kCalibrated).word(),
            "unexplained");
}

TEST(Likelihoods, NoiseIsSaidOnlyWhereNoTestDoubtsIt) {
  const std::vector<LikelihoodRecord> clear{{"a", 1, 10}, {"b", 1, 40}};
  EXPECT_THAT(JudgeLikelihoods(clear, {0.5}, 1e-3, kCalibrated).reason,
              HasSubstr("nothing but noise"));
  const auto doubtful = JudgeLikelihoods(clear, {0.004}, 1e-3, kCalibrated);
  EXPECT_EQ(doubtful.word(), "named");
  EXPECT_THAT(doubtful.reason, HasSubstr("significant at the level 0.002 (p = 0.004)"));
  EXPECT_THAT(JudgeLikelihoods({}, {0.004}, 0.3, kCalibrated).reason,
              HasSubstr("at the level 0.002"));
}

TEST(Likelihoods, TheClearlyLikeliestIsNamed) {
  const auto v =
      JudgeLikelihoods({{"a", 1, 10}, {"b", 1, 40}, {"c", 1, 34}}, {0.5}, 1e-3, kCalibrated);
  EXPECT_EQ(v.word(), "named");
  EXPECT_THAT(v.named, ElementsAre(1));
}

TEST(Likelihoods, OnesThatAreNotFarBehindAreKept) {
  const auto v =
      JudgeLikelihoods({{"a", 1, 10}, {"b", 1, 40}, {"c", 1, 36}}, {0.5}, 1e-3, kCalibrated);
  EXPECT_EQ(v.word(), "ambiguous");
  EXPECT_THAT(v.named, ElementsAre(1, 2));
}

TEST(Likelihoods, AnotherParameterMustEarnItsPlace) {
  // 3 more for one more parameter is less than 95 % of chance gives.
  const auto v = JudgeLikelihoods({{"plain", 1, 40}, {"rich", 2, 43}}, {0.5}, 1e-3, kCalibrated);
  EXPECT_EQ(v.named.front(), 0u);
}

TEST(Likelihoods, ALawThatContainsAnotherIsNamedOnlyWhenItClearlyBeatsIt) {
  const std::vector<std::size_t> inner{0};
  EXPECT_THAT(
      JudgeLikelihoods({{"plain", 1, 40}, {"rich", 2, 46, inner}}, {0.5}, 1e-3, kCalibrated).named,
      ElementsAre(0));
  EXPECT_THAT(
      JudgeLikelihoods({{"plain", 1, 40}, {"rich", 2, 60, inner}}, {0.5}, 1e-3, kCalibrated).named,
      ElementsAre(1));
}

TEST(Likelihoods, OnesWithinAShareOfWhatTheTimeStepLeavesOpenAreKept) {
  const auto named = [](double step) {
    return JudgeLikelihoods(
               {{"a", 1, 300, {}, 9000}, {"b", 1, 330, {}, step}, {"c", 1, 50, {}, 9000}}, {0.5},
               1e-3, kCalibrated)
        .named;
  };
  EXPECT_THAT(named(1000), ElementsAre(1));
  EXPECT_THAT(named(10000), ElementsAre(1, 0));
}

TEST(Likelihoods, OfALawAndOneThatItContainsThePlainOneIsKeptBesideAnother) {
  const std::vector<std::size_t> inner{0};
  EXPECT_THAT(JudgeLikelihoods({{"plain", 1, 40}, {"rich", 2, 44, inner}, {"other", 1, 42}}, {0.5},
                               1e-3, kCalibrated)
                  .named,
              ElementsAre(2, 0));
}

// One that nobody asked for, in a list of others.
LikelihoodRecord Unlisted(double likelihood, std::vector<std::size_t> contains = {}) {
  return {"unlisted", 1, likelihood, std::move(contains), 0, false};
}

TEST(Likelihoods, ANameThatOneOutsideTheListClearlyOutdoesIsNone) {
  const auto v = JudgeLikelihoods({{"a", 1, 40}, Unlisted(46)}, {0.5}, 1e-3, kCalibrated);
  EXPECT_EQ(v.word(), "unexplained");
  EXPECT_THAT(v.reason, HasSubstr("a, is clearly outdone by unlisted, which is not listed"));
}

TEST(Likelihoods, OneOutsideTheListThatDoesAsWellIsToldBesideTheName) {
  for (const double as_well : {36.0, 44.0}) {
    const auto v = JudgeLikelihoods({{"a", 1, 40}, Unlisted(as_well)}, {0.5}, 1e-3, kCalibrated);
    EXPECT_EQ(v.word(), "named");
    EXPECT_THAT(v.named, ElementsAre(0));
    EXPECT_THAT(v.unlisted, ElementsAre(1));
    EXPECT_THAT(v.reason, HasSubstr("not listed, but as likely (within 5): unlisted"));
  }
  EXPECT_THAT(JudgeLikelihoods({{"a", 1, 40}, Unlisted(34)}, {0.5}, 1e-3, kCalibrated).unlisted,
              IsEmpty());
}

TEST(Likelihoods, APlainLawOutsideTheListDoesNotTakeTheNameOfOneThatContainsIt) {
  const std::vector<std::size_t> inner{0};
  const auto v = JudgeLikelihoods({Unlisted(40), {"rich", 2, 44, inner}}, {0.5}, 1e-3, kCalibrated);
  EXPECT_THAT(v.named, ElementsAre(1));
  EXPECT_THAT(v.unlisted, ElementsAre(0));
}

TEST(Likelihoods, ARichLawOutsideTheListHasNothingToAdd) {
  const std::vector<std::size_t> inner{0};
  const auto v =
      JudgeLikelihoods({{"plain", 1, 40}, Unlisted(42, inner)}, {0.5}, 1e-3, kCalibrated);
  EXPECT_THAT(v.named, ElementsAre(0));
  EXPECT_THAT(v.unlisted, IsEmpty());
}

TEST(Likelihoods, NothingOutsideTheListMakesANameWhereNoneOfItHelps) {
  EXPECT_EQ(JudgeLikelihoods({{"a", 1, 2}, Unlisted(400)}, {0.5}, 1e-3, kCalibrated).word(),
            "adequate");
}

// 5000 squares above 100 of noise.
constexpr BaseSquares kLoud{5100, 100};

TEST(Likelihoods, TheMainCauseIsNamedWhereMoreThanNoiseIsLeft) {
  const auto v = JudgeLikelihoods({{"a", 1, 4800}, {"b", 1, 3000}}, {1e-6}, 1e-3, kLoud);
  EXPECT_EQ(v.word(), "named");
  EXPECT_FALSE(v.complete);
  EXPECT_NEAR(v.leading_share, 0.96, 1e-12);
  EXPECT_TRUE(JudgeLikelihoods({{"a", 1, 5000}}, {0.5}, 1e-3, kLoud).complete);
}

TEST(Likelihoods, WhatTakesLessThanTheMainShareLeadsButIsNotNamed) {
  const auto v = JudgeLikelihoods({{"a", 1, 3000}}, {1e-6}, 1e-3, kLoud);
  EXPECT_EQ(v.word(), "unexplained");
  EXPECT_THAT(v.named, IsEmpty());
  EXPECT_EQ(v.leading, 0u);
  EXPECT_NEAR(v.leading_share, 0.6, 1e-12);
}

TEST(Likelihoods, TheShareOfThePlainErrorCountsToo) {
  LikelihoodRecord a{"a", 1, 4800};
  a.error_share = 0.6;
  EXPECT_EQ(JudgeLikelihoods({a}, {1e-6}, 1e-3, kLoud).word(), "unexplained");
}

// The best leaves 200 squares above the noise: a rival that leaves 20 more is not behind on that
// scale, though twenty is much for noise.
TEST(Likelihoods, RivalsAreBehindByWhatIsLeftNotByNoiseAlone) {
  const auto verdict = [](double rival) {
    return JudgeLikelihoods({{"a", 1, 4800}, {"b", 1, rival}}, {1e-6}, 1e-3, kLoud).word();
  };
  EXPECT_EQ(verdict(4780), "ambiguous");
  EXPECT_EQ(verdict(4700), "named");
}

// Lengths that are wrong by a per cent leave that much of a large effect.
TEST(Likelihoods, OfALargeEffectTwoThatExplainItAllAreNotDistinguished) {
  constexpr BaseSquares kHuge{1e7, 1000};
  EXPECT_EQ(JudgeLikelihoods({{"a", 1, 9.998e6}, {"b", 1, 9.985e6}}, {1e-6}, 1e-3, kHuge).word(),
            "ambiguous");
  EXPECT_EQ(JudgeLikelihoods({{"a", 1, 9.998e6}, {"b", 1, 9.9e6}}, {1e-6}, 1e-3, kHuge).word(),
            "named");
}

// Friction that grows with the load makes up for a length that is wrong, on the logs of the fit.
TEST(Likelihoods, ALawThatContainsAnotherMustEarnItsNameOnLogsLeftOut) {
  LikelihoodRecord plain{"plain", 1, 4700}, rich{"rich", 2, 4900, {0}};
  plain.held_out = 1;
  for (const auto& [held_out, named] : {std::pair{0.95, 0u}, std::pair{0.8, 1u}}) {
    rich.held_out = held_out;
    const auto v = JudgeLikelihoods({plain, rich}, {1e-6}, 1e-3, kLoud);
    EXPECT_EQ(v.word(), "named");
    EXPECT_THAT(v.named, ElementsAre(named));
    EXPECT_EQ(v.siblings.size(), 1 - named);
  }
  // Where nothing but noise is left the likelihoods judge.
  rich.held_out = 0.99;
  EXPECT_THAT(JudgeLikelihoods({plain, rich}, {0.5}, 1e-3, kLoud).named, ElementsAre(1));
}

TEST(Likelihoods, SiblingsMakeNoSet) {
  LikelihoodRecord plain{"plain", 1, 4700}, rich{"rich", 2, 4790}, other{"other", 1, 4000};
  plain.kin = {"friction", 0}, rich.kin = {"friction", 1};
  const auto v = JudgeLikelihoods({rich, plain, other}, {1e-6}, 1e-3, kLoud);
  EXPECT_EQ(v.word(), "named");
  EXPECT_THAT(v.named, ElementsAre(1));
  EXPECT_THAT(v.siblings, ElementsAre(0));
}

TEST(Kin, IsOfOneFamilyInAnyOrderOfTwoCauses) {
  EXPECT_TRUE(KinOf("coulomb").Of(KinOf("dahl")));
  EXPECT_FALSE(KinOf("coulomb").Of(KinOf("pt1")));
  EXPECT_FALSE(KinOf("viscous").Of(KinOf("viscous")));
  EXPECT_TRUE(KinOf("coulomb", "payload").Of(KinOf("armature", "dahl")));
  EXPECT_LT(KinOf("coulomb").depth, KinOf("dahl").depth);
}

TEST(Likelihoods, ProbabilitiesAddUpToOne) {
  const auto p = ProbabilitiesOf({{"a", 1, 10}, {"b", 1, 12}, {"c", 2, 12}});
  EXPECT_NEAR(p[0] + p[1] + p[2], 1, 1e-12);
  EXPECT_NEAR(p[1] / p[0], std::exp(1), 1e-9);
  EXPECT_LT(p[2], p[1]);
}

}  // namespace
}  // namespace continuum
