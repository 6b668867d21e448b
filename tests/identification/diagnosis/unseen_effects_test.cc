#include "identification/diagnosis/unseen_effects.h"

#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

class Unseen : public testing::Bench {
 protected:
  Diagnosis Adequate() {
    AddLog("t0", "trial: t0, use: train", {0, 0}, {0, 0});
    experiment_ = ReadExperiment("");
    Diagnosis d(experiment_, ModelSpec::Load(Write("model.xml", testing::Pendulum().Xml())));
    d.verdict = Verdict::Adequate("no candidate lowers the error");
    return d;
  }
  static Dismissed Left(Dismissed::Why why) { return {"dahl", "", "joint hinge", 0, 1, why}; }

  Experiment experiment_;
};

TEST_F(Unseen, NothingIsAdequateThatNoCandidateWasFittedTo) {
  Diagnosis d = Adequate();
  d.dismissed = {Left(Dismissed::Why::kNoTimeForAFit)};
  WeighUnseen(d);
  EXPECT_EQ(d.verdict.word(), "unexplained");
  EXPECT_EQ(d.verdict.reason, "there was no time to try a candidate");
}

TEST_F(Unseen, WhatExplainsNothingNeedsNoFit) {
  Diagnosis d = Adequate();
  d.dismissed = {Left(Dismissed::Why::kExplainsTooLittle)};
  WeighUnseen(d);
  EXPECT_EQ(d.verdict.word(), "adequate");
}

}  // namespace
}  // namespace continuum
