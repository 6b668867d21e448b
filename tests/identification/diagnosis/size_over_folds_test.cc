#include "identification/diagnosis/size_over_folds.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kRounding = 1e-12;

// One parameter of the model, then a law: two amplitudes and a shape, which means nothing in its
// absence. Two logs.
CandidateResult Law(const Vector& fit, const std::vector<Vector>& folds) {
  constexpr double kShape = std::numeric_limits<double>::quiet_NaN();
  CandidateResult c{{"law", "", "joint q", ModelSpec::Parse("<mujoco/>"), {}, {}, "", {}}};
  c.hypothesis.extra.resize(3);
  for (Parameter& p : c.hypothesis.extra) p.lower = 0, p.upper = 10;
  c.hypothesis.null = {0, 0, kShape};
  c.fitted.fit.x = fit;
  c.fitted.folds.x = folds;
  c.fitted.sensitivities.emplace();
  return c;
}

Vector Of(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), std::ssize(values));
}

TEST(SizeOverFolds, OfOneAmplitudeIsItsValue) {
  CandidateResult c = Law(Of({5, 2, 0, 1}), {Of({7, 2.5, 0, 4}), Of({5, -1, 0, 1})});
  c.fitted.sensitivities->jacobian = {Matrix::Random(6, 4), Matrix::Random(3, 4)};
  EXPECT_THAT(SizeOverFolds(c), ElementsAre(DoubleNear(2.5, kRounding), DoubleNear(-1, kRounding)));
}

// What one of them loses the other has.
TEST(SizeOverFolds, OfTwoThatDoTheSameIsThatOfBoth) {
  CandidateResult c = Law(Of({5, 2, 1, 1}), {Of({5, 0.5, 2.5, 1}), Of({5, 4, 2, 1})});
  Matrix J = Matrix::Random(8, 4);
  J.col(2) = J.col(1);
  c.fitted.sensitivities->jacobian = {J};
  EXPECT_THAT(SizeOverFolds(c), ElementsAre(DoubleNear(2, kRounding), DoubleNear(4, kRounding)));
}

TEST(SizeOverFolds, CountsAFactorFromOne) {
  CandidateResult c = Law(Of({5, 1.5, 0, 1}), {Of({5, 1.25, 0, 1})});
  c.hypothesis.null[0] = 1;
  c.fitted.sensitivities->jacobian = {Matrix::Random(6, 4)};
  EXPECT_THAT(SizeOverFolds(c), ElementsAre(DoubleNear(0.25, kRounding)));
}

TEST(SizeOverFolds, IsNoneOfALawThatDoesNothing) {
  CandidateResult c = Law(Of({5, 2, 0, 1}), {Of({5, 2, 0, 1})});
  c.fitted.sensitivities->jacobian = {Matrix::Zero(6, 4)};
  EXPECT_TRUE(std::isnan(SizeOverFolds(c).front()));
}

}  // namespace
}  // namespace continuum
