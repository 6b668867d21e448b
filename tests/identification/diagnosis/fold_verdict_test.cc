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

TEST(HoldsOnValidateLogs, AsksForHalfOfWhatTheFoldsGiveInTheMedian) {
  EXPECT_FALSE(HoldsOnValidateLogs(1, 0.96, 0.1));
  EXPECT_TRUE(HoldsOnValidateLogs(1, 0.94, 0.1));
  EXPECT_TRUE(HoldsOnValidateLogs(1, 0.96, 0.9));  // noise leaves no more than 10 % open
  EXPECT_FALSE(HoldsOnValidateLogs(1, 0.99, 0.9));
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

}  // namespace
}  // namespace continuum
