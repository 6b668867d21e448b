#include "identification/diagnosis/unseen_effects.h"

#include <gtest/gtest.h>

#include "support/bare_diagnosis.h"

namespace continuum {
namespace {

class Unseen : public testing::BareDiagnosis {
 protected:
  Diagnosis Adequate() {
    Diagnosis d = Bare();
    d.verdict = Verdict::Adequate("no candidate lowers the error");
    return d;
  }
  static Dismissed Left(Dismissed::Why why) { return {"dahl", "", "joint hinge", 0, 1, why}; }
};

TEST_F(Unseen, NothingIsAdequateThatNoCandidateWasFittedTo) {
  Diagnosis d = Adequate();
  d.dismissed = {Left(Dismissed::Why::kNoTimeForAFit)};
  WeighUnseen(d);
  EXPECT_EQ(d.verdict.word(), "unexplained");
  EXPECT_EQ(d.verdict.reason, "there was no time to try 1 of 1 effects");
  EXPECT_TRUE(d.verdict.open);
}

// A quarter of the effects is too many.
TEST_F(Unseen, NothingIsAdequateWhereMostHadNoTime) {
  for (const bool many : {false, true}) {
    Diagnosis d = Adequate();
    for (const char* tried : {"payload", "coulomb", "maxwell"}) {
      d.dismissed.push_back(Left(Dismissed::Why::kExplainsTooLittle));
      d.dismissed.back().effect = tried;
    }
    d.candidates.push_back({{"stribeck", "", "joint hinge", d.system, {}, {}, "", {}}});
    d.candidates.back().was_fitted = true;
    d.dismissed.push_back(Left(Dismissed::Why::kNoTimeForAFit));
    if (many) d.dismissed.push_back(Left(Dismissed::Why::kNoTimeForALook));
    if (many) d.dismissed.back().effect = "lugre";
    WeighUnseen(d);
    EXPECT_EQ(d.verdict.word(), many ? "unexplained" : "adequate");
  }
}

TEST_F(Unseen, WhatExplainsNothingNeedsNoFit) {
  Diagnosis d = Adequate();
  d.dismissed = {Left(Dismissed::Why::kExplainsTooLittle)};
  WeighUnseen(d);
  EXPECT_EQ(d.verdict.word(), "adequate");
}

// What no candidate explains a force without a name may.
TEST_F(Unseen, NothingIsAdequateThatNoForceWasFittedTo) {
  Diagnosis d = Adequate();
  d.dismissed = {Left(Dismissed::Why::kExplainsTooLittle)};
  d.left_out = {"forces without a name"};
  WeighUnseen(d);
  EXPECT_EQ(d.verdict.word(), "unexplained");
  EXPECT_EQ(d.verdict.reason,
            "no candidate was fitted, and there was no time for forces without a name");
}

}  // namespace
}  // namespace continuum
