#include "identification/diagnosis/needless_sizes.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using testing::kPeriod;
using testing::Noisy;
using testing::Pendulum;

// A pendulum on a servo, gravity in its plane turned by `tilt`: it hangs at −tilt.
std::vector<double> Tilted(const std::vector<double>& u, double tilt) {
  constexpr double h = 2e-5, g = 9.81;
  const Pendulum p;
  const double mass = p.bob + p.tip, j = p.inertia + mass * p.length * p.length;
  double q = 0, v = 0;
  std::vector<double> angle;
  for (const double input : u) {
    angle.push_back(q);
    for (double t = 0; t < kPeriod - h / 2; t += h) {
      const double weight = mass * g * p.length * std::sin(q + tilt);
      v += h * (p.kp * (input - q) - p.damping * v - weight) / j;
      q += h * v;
    }
  }
  return angle;
}

class NeedlessSizes : public testing::Bench {
 protected:
  // The only candidate of that name, fitted to logs with a tilt of 0.03 rad.
  CandidateResult Fitted(const std::string& effect) {
    for (int trial = 0; trial < 2; ++trial) {
      const auto u = Command(trial, 150);
      AddLog("log" + std::to_string(trial), "use: train", u,
             Noisy(Tilted(u, 0.03), 1e-3, 0, static_cast<unsigned>(trial + 1)));
    }
    e_ = ReadExperiment("candidates: [" + effect + "]\n", ", sigma: 0.001");
    const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 5e-4)));
    fitter_.experiment = &e_;
    const Problem null(e_, system);
    fitter_.whitening = Whitening(null, NoiseOf(e_));
    const auto base = fitter_.FitAll(null, null.Start());
    std::vector<std::string> skipped;
    const auto all = MakeCandidates(e_, {&system}, SizesOf(null, base.fit.x), skipped);
    CandidateResult c{all.at(0)};
    const std::vector<double>& start = c.hypothesis.starts.front();
    c.fitted = fitter_.FitAll(ProblemOf(c, e_),
                              Eigen::Map<const Problem::Vector>(start.data(), std::ssize(start)));
    return c;
  }

  Experiment e_;
  CandidateFitter fitter_{nullptr};
};

// Out of its plane a tilt changes little of what a pendulum does, and nothing of that is there.
TEST_F(NeedlessSizes, OneAxisOfATiltIsEnough) {
  CandidateResult c = Fitted("gravity_tilt");
  ASSERT_EQ(c.hypothesis.extra.size(), 2u);
  const double cost = c.fitted.cost;
  EXPECT_TRUE(DropNeedlessSizes(fitter_, c));
  ASSERT_EQ(c.hypothesis.extra.size(), 1u);
  EXPECT_EQ(c.hypothesis.extra[0].name, "pitch");
  EXPECT_NEAR(std::abs(c.fitted.fit.x[0]), 0.03, 1e-3);
  EXPECT_LT(c.fitted.cost - cost, 6.7);
  EXPECT_FALSE(DropNeedlessSizes(fitter_, c));  // the last one stays
}

// The same tilt as the cause beside which another one was fitted.
TEST_F(NeedlessSizes, OfTheCauseBesideItGoTheSameWay) {
  CandidateResult c = Fitted("gravity_tilt");
  Hypothesis tilt = c.hypothesis;
  c.hypothesis.given = tilt.extra;
  c.hypothesis.extra.clear(), c.hypothesis.null.clear(), c.hypothesis.starts.clear();
  EXPECT_TRUE(DropNeedlessSizes(fitter_, c, tilt));
  ASSERT_EQ(tilt.extra.size(), 1u);
  EXPECT_EQ(tilt.extra[0].name, "pitch");
  ASSERT_EQ(c.hypothesis.given.size(), 1u);
  EXPECT_EQ(c.hypothesis.given[0].name, "pitch");
  EXPECT_NEAR(std::abs(c.fitted.fit.x[0]), 0.03, 1e-3);
}

TEST_F(NeedlessSizes, AFrictionKeepsItsOwn) {
  CandidateResult c = Fitted("stribeck");
  const std::size_t sizes = c.hypothesis.extra.size();
  EXPECT_FALSE(DropNeedlessSizes(fitter_, c));
  EXPECT_EQ(c.hypothesis.extra.size(), sizes);
}

// Of two logs, after one number that is fitted anyway; the columns are those of the candidate.
CandidateResult WithColumns(std::vector<Problem::Vector> columns) {
  CandidateResult c{{"", "", "", ModelSpec::Parse("<mujoco/>"), {}, {}, "", {}}};
  Sensitivities known;
  known.jacobian.assign(2, Problem::Matrix::Ones(4, 1 + static_cast<int>(columns.size())));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    c.hypothesis.extra.emplace_back();
    c.hypothesis.extra.back().lower = -1, c.hypothesis.extra.back().upper = 1;
    for (auto& J : known.jacobian) J.col(1 + static_cast<int>(i)) = columns[i];
  }
  c.fitted.fit.x = Problem::Vector::Zero(1 + static_cast<int>(columns.size()));
  c.fitted.sensitivities = known;
  return c;
}

TEST(NumbersThatShow, AreThoseThatChangeTheLogsEachInItsOwnWay) {
  const Eigen::Vector4d none(0, 0, 0, 0), a(1, 2, 3, 4), b(1, -1, 1, -1);
  EXPECT_EQ(NumbersThatShow(WithColumns({none, a, none})), 1u);
  EXPECT_EQ(NumbersThatShow(WithColumns({a, -0.1 * a})), 1u);
  EXPECT_EQ(NumbersThatShow(WithColumns({a, b})), 2u);
  EXPECT_EQ(NumbersThatShow(WithColumns({a, a + 0.01 * b, b})), 2u);
  CandidateResult unknown = WithColumns({none, a});
  unknown.fitted.sensitivities.reset();
  EXPECT_EQ(NumbersThatShow(unknown), 2u);
}

}  // namespace
}  // namespace continuum
