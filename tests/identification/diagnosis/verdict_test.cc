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

// Only noise is left, whatever was explained: nothing is known of the model before.
constexpr BaseSquares kCalibrated{};

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

// A pendulum's load and a weak motor both explain all of a large effect but for a per cent, which
// its length is uncertain by: that one of them happens to leave nothing does not tell them apart.
TEST(Likelihoods, OnesThatLeaveAPerCentOfALargeEffectAreKept) {
  const auto named = [](double left) {
    return JudgeLikelihoods({{"load", 1, 1e8 * (1 - left * left)}, {"gain", 1, 1e8}}, {0.5}, 1e-3,
                            kCalibrated)
        .named;
  };
  EXPECT_THAT(named(0.009), ElementsAre(1, 0));
  EXPECT_THAT(named(0.011), ElementsAre(1));
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

TEST(Likelihoods, APlainLawOutsideTheListTakesTheNameOfOneThatContainsItAndAddsNothing) {
  const auto with = [](double rich) {
    const std::vector<std::size_t> inner{0};
    return JudgeLikelihoods({Unlisted(40), {"rich", 2, rich, inner}}, {0.5}, 1e-3, kCalibrated);
  };
  EXPECT_EQ(with(44).word(), "unexplained");
  EXPECT_THAT(with(44).reason,
              HasSubstr("unlisted, which is not listed, says in fewer numbers what the best "
                        "candidate, rich, does"));
  EXPECT_THAT(with(50).named, ElementsAre(1));
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

TEST(Likelihoods, OneOutsideTheListThatTakesTheMainShareIsToldWhereNoneOfTheListDoes) {
  const auto v = JudgeLikelihoods({{"a", 1, 2000}, Unlisted(4800)}, {1e-6}, 1e-3, kLoud);
  EXPECT_EQ(v.explained_by, "unlisted");
  EXPECT_THAT(v.reason, HasSubstr("a, is clearly outdone by unlisted"));
  EXPECT_EQ(JudgeLikelihoods({{"a", 1, 2000}, Unlisted(3000)}, {1e-6}, 1e-3, kLoud).explained_by,
            "");
  const std::vector<std::size_t> inner{0};
  EXPECT_EQ(
      JudgeLikelihoods({{"a", 1, 2000}, Unlisted(4800, inner)}, {1e-6}, 1e-3, kLoud).explained_by,
      "");
}

TEST(Likelihoods, TheMainCauseIsNamedWhereMoreThanNoiseIsLeft) {
  const auto v = JudgeLikelihoods({{"a", 1, 4800}, {"b", 1, 3000}}, {1e-6}, 1e-3, kLoud);
  EXPECT_EQ(v.word(), "named");
  EXPECT_FALSE(v.complete);
  EXPECT_NEAR(v.leading_share, 0.96, 1e-12);
  EXPECT_TRUE(JudgeLikelihoods({{"a", 1, 5000}}, {0.5}, 1e-3, kLoud).complete);
}

TEST(Likelihoods, WhatTakesLessThanTheMainShareLeadsButIsNotNamed) {
  LikelihoodRecord a{"a", 1, 3000};
  a.error_share = 0.6;
  const auto v = JudgeLikelihoods({a}, {1e-6}, 1e-3, kLoud);
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

// A constant under noise that is the same over a log: many squares are of fast motion.
TEST(Likelihoods, OneThatTakesAllOfTheErrorIsNamedThoughAnotherTakesMoreSquares) {
  LikelihoodRecord fast{"fast", 1, 3000}, constant{"constant", 1, 400};
  fast.error_share = 0.1, constant.error_share = 0.97;
  const std::vector candidates{fast, constant};
  EXPECT_EQ(JudgeLikelihoods(candidates, {1e-6}, 1e-3, kLoud).word(), "unexplained");
  const auto v = NameByError(candidates);
  ASSERT_TRUE(v);
  EXPECT_EQ(v->word(), "named");
  EXPECT_THAT(v->named, ElementsAre(1));
  EXPECT_FALSE(v->complete);
  EXPECT_NEAR(v->leading_share, 0.97, 1e-12);
}

// A mass that is two per cent off, a clock that is one per cent off: what is left is as much.
TEST(Likelihoods, ASmallCorrectionIsOneOfAllThatDoMoreThanItLeaves) {
  LikelihoodRecord a{"a", 1, 4400}, b{"b", 1, 3900}, c{"c", 1, 3700};
  EXPECT_THAT(JudgeLikelihoods({a, b, c}, {1e-6}, 1e-3, kLoud).named, ElementsAre(0));
  a.corrects = true;
  EXPECT_THAT(JudgeLikelihoods({a, b, c}, {1e-6}, 1e-3, kLoud).named, ElementsAre(0, 1));
}

// A gain of a third says what a large mass says; nothing else does: then it is the gain.
TEST(Likelihoods, AFactorThatIsFarOffIsNoCauseBesideAnotherThatDoesAsWell) {
  LikelihoodRecord gain{"input_gain", 1, 4790}, mass{"payload", 1, 4780}, other{"other", 1, 3000};
  EXPECT_THAT(JudgeLikelihoods({gain, mass, other}, {1e-6}, 1e-3, kLoud).named, ElementsAre(0, 1));
  gain.far_off = true;
  const Verdict v = JudgeLikelihoods({gain, mass, other}, {1e-6}, 1e-3, kLoud);
  EXPECT_THAT(v.named, ElementsAre(1));
  EXPECT_EQ(v.word(), "named");
  EXPECT_THAT(v.reason, HasSubstr("of no plausible size: input_gain"));
  mass.likelihood = 4000;
  EXPECT_THAT(JudgeLikelihoods({gain, mass, other}, {1e-6}, 1e-3, kLoud).named, ElementsAre(0));
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

// As a load friction beside late sensors, where it says what Coulomb's does, of a friction and a
// late input.
TEST(Likelihoods, WhatContainsASiblingAndAddsNothingIsNoRival) {
  LikelihoodRecord best{"a", 1, 40}, sibling{"b", 1, 40}, rich{"c", 2, 41, {1}};
  best.kin = sibling.kin = {"lateness", 0};
  EXPECT_THAT(JudgeLikelihoods({best, sibling, rich}, {0.5}, 1e-3, kCalibrated).named,
              ElementsAre(0));
  rich.contains.clear();
  EXPECT_THAT(JudgeLikelihoods({best, sibling, rich}, {0.5}, 1e-3, kCalibrated).named,
              ElementsAre(0, 2));
}

// Delays beside a lag that do as well as it: the set has the plainest of them.
TEST(Likelihoods, OfEachFamilyOneStandsInASet) {
  LikelihoodRecord best{"best", 1, 4700}, rich{"rich", 1, 4698}, plain{"plain", 1, 4697},
      other{"other", 1, 4699};
  rich.kin = {"lateness", 1}, plain.kin = {"lateness", 0};
  const auto v = JudgeLikelihoods({best, rich, plain, other}, {1e-6}, 1e-3, kLoud);
  EXPECT_EQ(v.word(), "ambiguous");
  EXPECT_THAT(v.named, ElementsAre(0, 3, 2));
  EXPECT_THAT(v.siblings, ElementsAre(1));
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

// Lags are simulated alike by everybody, dry friction is not.
TEST(JudgeLikelihoods, APlainLagDoesNotStandForOneThatAloneLeavesOnlyNoise) {
  for (const std::string family : {"lateness", "dry friction"}) {
    LikelihoodRecord plain{"plain", 1, 970}, rich{"rich", 2, 1000};
    plain.kin = {family, 0}, rich.kin = {family, 1};
    const Verdict v = JudgeLikelihoods({plain, rich}, {}, 1e-3, {}, {});
    ASSERT_EQ(v.word(), "named") << v.reason;
    const bool lag = family == "lateness";
    EXPECT_EQ(v.named.front(), lag ? 1u : 0u);
    EXPECT_THAT(v.siblings, ElementsAre(lag ? 0u : 1u));
  }
}

}  // namespace
}  // namespace continuum
