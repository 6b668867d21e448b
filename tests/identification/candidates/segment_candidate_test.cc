#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"

namespace continuum {
namespace {

const std::string kModule = CONTINUUM_SOURCE "/models/stiff_flop/stiff_flop.xml";

std::string Key(const Hypothesis& h, const std::string& key) {
  for (const auto& [name, value] : h.instance.config) {
    if (name == key) return value;
  }
  return "";
}

TEST(SegmentCandidates, LieBesideTheSegmentWithItsPlacesAndGeometry) {
  Experiment e;
  e.all_candidates = false;
  e.candidates = {{"braid", "", false}, {"chamber_asymmetry", "", false}};
  std::vector<std::string> skipped;
  const ModelSpec module = ModelSpec::Load(kModule);
  const auto all = MakeCandidates(e, {&module}, {}, skipped);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_THAT(skipped, ::testing::IsEmpty());
  for (const Hypothesis& h : all) {
    EXPECT_EQ(h.where, "segment segment");
    EXPECT_EQ(Key(h, "body"), "base link6");
    EXPECT_EQ(Key(h, "actuator"), "p1 p2 p3");
    EXPECT_EQ(Key(h, "d"), "0.0125");
  }
  ASSERT_EQ(all[0].extra.size(), 1U);
  EXPECT_EQ(all[0].extra[0].name, "cot2_gamma");
  EXPECT_EQ(Key(all[0], "r_ch"), "0.0085");
  ASSERT_EQ(all[1].extra.size(), 2U);
  EXPECT_EQ(Key(all[1], "actuation"), "volume");
  EXPECT_EQ(all[1].null, (std::vector<double>{0, 0}));
  // A shift is looked for within 15 % of d.
  EXPECT_NEAR(all[1].extra[0].upper, 0.15 * 0.0125, 1e-12);
}

TEST(SegmentCandidates, AreLeftOutWithoutASegmentAndWhereTheExperimentFitsThem) {
  Experiment e;
  e.all_candidates = false;
  e.candidates = {{"pcc_segment", "", false}, {"chamber_asymmetry", "", false}};
  Parameter fitted;
  fitted.name = "x_m", fitted.target = "plugin:segment", fitted.attribute = "x_m";
  e.parameters = {fitted};
  std::vector<std::string> skipped;
  const ModelSpec module = ModelSpec::Load(kModule);
  EXPECT_THAT(MakeCandidates(e, {&module}, {}, skipped), ::testing::IsEmpty());
  EXPECT_THAT(skipped, ::testing::ElementsAre("pcc_segment: the model has it already",
                                              "chamber_asymmetry: the experiment fits it already"));
  skipped.clear();
  e.candidates = {{"braid", "", false}};
  const ModelSpec arm = ModelSpec::Load(CONTINUUM_SOURCE "/models/emps/emps.xml");
  EXPECT_THAT(MakeCandidates(e, {&arm}, {}, skipped), ::testing::IsEmpty());
  EXPECT_THAT(skipped, ::testing::ElementsAre("braid: no soft segment in the model"));
}

}  // namespace
}  // namespace continuum
