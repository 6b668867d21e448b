#include "identification/diagnosis/family_starts.h"

#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/probing.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

class FamilyStartsTest : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    const auto u = Command(1, kRows);
    AddLog("t", "trial: t, use: train", u, Pendulum().Run(u, testing::kPeriod));
    const ModelSpec& system =
        system_.emplace(ModelSpec::Load(Write("model.xml", Pendulum().Xml())));
    experiment_ = ReadExperiment("candidates: all\n");
    const Problem null(experiment_, system);
    base_ = null.Start();
    std::vector<std::string> skipped;
    all_ = MakeCandidates(experiment_, {&system}, SizesOf(null, base_), skipped);
  }

  const Hypothesis& Named(const std::string& effect) const {
    for (const Hypothesis& h : all_) {
      if (h.effect == effect) return h;
    }
    throw std::out_of_range(effect);
  }
  // With a fit that moved the model's parameters too.
  CandidateResult Fitted(const std::string& effect, double size) const {
    CandidateResult c{Named(effect)};
    c.was_fitted = true;
    c.fitted.fit.x = Append(1.5 * base_, {size});
    return c;
  }
  double Of(const Hypothesis& h, const Problem::Vector& x, const std::string& name) const {
    for (std::size_t i = 0; i < h.extra.size(); ++i) {
      if (h.extra[i].name == name) return x[base_.size() + static_cast<Eigen::Index>(i)];
    }
    throw std::out_of_range(name);
  }

  static constexpr std::size_t kRows = 200;
  static constexpr double kLevel = 0.007;  // N m
  Experiment experiment_;
  std::optional<ModelSpec> system_;
  Problem::Vector base_;
  std::vector<Hypothesis> all_;
};

TEST_F(FamilyStartsTest, AStribeckFrictionBeginsAsTheCoulombFrictionAtEverySpeed) {
  const Hypothesis& rich = Named("stribeck");
  const auto starts = StartsFromPlain(Fitted("coulomb", kLevel), rich);
  ASSERT_GT(starts.size(), 3u);
  EXPECT_EQ(Of(rich, starts.front(), "S"), 0);
  std::set<double> speeds;
  for (const auto& x : starts) {
    EXPECT_EQ(x.head(base_.size()), 1.5 * base_);
    EXPECT_DOUBLE_EQ(Of(rich, x, "tau_c"), kLevel);
    speeds.insert(Of(rich, x, "v_d"));
  }
  EXPECT_GE(speeds.size(), 5u);
  for (std::size_t i = 1; i < starts.size(); ++i) EXPECT_GT(Of(rich, starts[i], "S"), 0);
}

TEST_F(FamilyStartsTest, BothDirectionsTakeOverTheLevel) {
  const Hypothesis& rich = Named("directional_friction");
  const auto starts = StartsFromPlain(Fitted("coulomb", kLevel), rich);
  ASSERT_FALSE(starts.empty());
  EXPECT_DOUBLE_EQ(Of(rich, starts.front(), "tau_c_plus"), kLevel);
  EXPECT_DOUBLE_EQ(Of(rich, starts.front(), "tau_c_minus"), kLevel);
}

TEST_F(FamilyStartsTest, LawsWithoutACommonSizeShareNoStart) {
  EXPECT_TRUE(IsPlainerThan(Named("pt1"), Named("pt2")));
  EXPECT_TRUE(StartsFromPlain(Fitted("pt1", 0.02), Named("pt2")).empty());
}

TEST_F(FamilyStartsTest, APlainLawBeginsWithTheLevelOfARichOne) {
  const Hypothesis &rich = Named("position_friction"), &plain = Named("coulomb");
  CandidateResult found{rich};
  found.was_fitted = true;
  std::vector<double> own(rich.extra.size(), 0.001);
  for (std::size_t i = 0; i < own.size(); ++i)
    own[i] = rich.extra[i].name == "tau_c" ? kLevel : own[i];
  found.fitted.fit.x = Append(1.5 * base_, own);
  const auto start = StartFromRich(found, plain);
  ASSERT_TRUE(start.has_value());
  EXPECT_EQ(start->head(base_.size()), 1.5 * base_);
  EXPECT_DOUBLE_EQ(Of(plain, *start, "tau_c"), kLevel);
}

// The level of Dahl's law is f.
TEST_F(FamilyStartsTest, WithoutACommonNameTheUnitTellsTheLevel) {
  CandidateResult found{Named("dahl")};
  found.was_fitted = true;
  std::vector<double> own;
  for (const Parameter& p : found.hypothesis.extra) own.push_back(p.name == "f" ? kLevel : 100);
  found.fitted.fit.x = Append(base_, own);
  EXPECT_DOUBLE_EQ(Of(Named("coulomb"), *StartFromRich(found, Named("coulomb")), "tau_c"), kLevel);
  EXPECT_FALSE(StartFromRich(found, Named("pt1")).has_value());
}

TEST_F(FamilyStartsTest, OnlyAFamilyHasPlainerLaws) {
  EXPECT_TRUE(IsPlainerThan(Named("coulomb"), Named("load_friction")));  // contained, no kin
  EXPECT_TRUE(IsPlainerThan(Named("coulomb"), Named("dahl")));
  EXPECT_FALSE(IsPlainerThan(Named("dahl"), Named("coulomb")));
  EXPECT_FALSE(IsPlainerThan(Named("dahl"), Named("lugre")));  // as deep
  EXPECT_FALSE(IsPlainerThan(Named("viscous"), Named("stribeck")));
}

}  // namespace
}  // namespace continuum
