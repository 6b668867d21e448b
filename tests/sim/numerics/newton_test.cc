#include "sim/numerics/newton.h"

#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>

#include "error.h"
#include "sim/numerics/continuation.h"
#include "sim/numerics/levenberg_marquardt.h"

namespace continuum::numerics {
namespace {

using testing::HasSubstr;

struct Circle {  // x^2 + y^2 = 4, x y = 1
  template <class T>
  bool operator()(const T* x, T* f) const {
    f[0] = x[0] * x[0] + x[1] * x[1] - 4.0;
    f[1] = x[0] * x[1] - 1.0;
    return true;
  }
};

struct Logarithm {  // log x = 1, only defined for x > 0
  template <class T>
  bool operator()(const T* x, T* f) const {
    using std::log;
    if (!(x[0] > T(0))) return false;
    f[0] = log(x[0]) - 1.0;
    return true;
  }
};

struct Arctangent {  // full Newton steps diverge from beyond 1.39
  template <class T>
  bool operator()(const T* x, T* f) const {
    using std::atan;
    f[0] = atan(x[0]);
    return true;
  }
};

struct NoRoot {
  template <class T>
  bool operator()(const T* x, T* f) const {
    f[0] = x[0] * x[0] + 1.0;
    return true;
  }
};

using One = Eigen::Matrix<double, 1, 1>;

TEST(NewtonDeathTest, EndsWhenTheUserAsksToStop) {
  const auto solve = [] {
    RequestStop();
    One x(1);
    try {
      Newton(Logarithm{}, x);
    } catch (const Error& error) {
      std::_Exit(std::string(error.what()) == "interrupted" ? 7 : 8);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(solve(), ::testing::ExitedWithCode(7), "");
}

TEST(Newton, FindsARootWithDualNumbers) {
  Eigen::Vector2d x(2, 0.3);
  const Outcome outcome = Newton(Circle{}, x);
  ASSERT_TRUE(outcome.ok());
  EXPECT_NEAR(x[0] * x[1], 1, 1e-12);
  EXPECT_LE(outcome.residual, 1e-12);
  EXPECT_LT(outcome.iterations, 8);
}

TEST(Newton, StepsBackFromOutsideTheDomain) {
  One x(40);  // the full step lands at a negative x
  ASSERT_TRUE(Newton(Logarithm{}, x).ok());
  EXPECT_NEAR(x[0], std::exp(1), 1e-10);
}

TEST(Newton, IsDampedWhereFullStepsDiverge) {
  One x(20);
  ASSERT_TRUE(Newton(Arctangent{}, x).ok());
  EXPECT_NEAR(x[0], 0, 1e-11);
}

TEST(Newton, SaysWhyItFailed) {
  One x(3);
  const Outcome none = Newton(NoRoot{}, x);
  EXPECT_EQ(none.status, Status::kNoConvergence);
  EXPECT_FALSE(none.why.empty());
  x[0] = -1;
  EXPECT_EQ(Newton(Logarithm{}, x).status, Status::kOutOfDomain);
}

struct Chained {  // x_i^3 + x_i - x_{i-1} = 0 with x_0 = 2, of any size
  int n;
  template <class T>
  bool operator()(const T* x, T* f) const {
    for (int i = 0; i < n; ++i) f[i] = x[i] * x[i] * x[i] + x[i] - (i > 0 ? x[i - 1] : T(2));
    return true;
  }
};

TEST(Linearize, DualBlocksGiveTheJacobianOfAnySize) {
  for (const int n : {1, 7, 8, 9, 20}) {
    const Chained problem{n};
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 0.2, 1), f(n), g(n);
    Eigen::MatrixXd exact(n, n), rough(n, n);
    ASSERT_TRUE(Linearize(problem, x, f, exact));
    ASSERT_TRUE(Differences(problem, x, 1e-5, g, rough));
    EXPECT_LT((exact - rough).cwiseAbs().maxCoeff(), 1e-9);  // step^2 and rounding/step
    EXPECT_TRUE(Newton(problem, x).ok());
  }
}

struct Decay {  // samples of 2 exp(-0.3 t) with a known remainder
  template <class T>
  bool operator()(const T* x, T* f) const {
    using std::exp;
    for (int i = 0; i < 5; ++i) {
      f[i] = x[0] * exp(-x[1] * double(i)) - 2 * std::exp(-0.3 * i) + 0.01 * (i % 2);
    }
    return true;
  }
};

TEST(LevenbergMarquardt, ReachesTheMinimumWhereTheGradientVanishes) {
  Eigen::Vector2d x(1, 1);
  const auto outcome = LevenbergMarquardt<Eigen::Matrix<double, 5, 1>>(Decay{}, x, 5);
  ASSERT_TRUE(outcome.ok());
  Eigen::Matrix<double, 5, 1> f;
  Eigen::Matrix<double, 5, 2> jacobian;
  ASSERT_TRUE(Linearize(Decay{}, x, f, jacobian));
  // |f|^2 stops changing at 1e-16 of itself, its gradient at the root of that.
  EXPECT_LT((jacobian.transpose() * f).norm(), 1e-9);
  EXPECT_NEAR(outcome.residual, f.norm(), 1e-15);
}

TEST(LevenbergMarquardt, StopsAtABoundThatHoldsTheMinimum) {
  Eigen::Vector2d x(1, 1);
  Bounds<2> bounds;
  bounds.lower << 0, 0.5;
  const auto outcome = LevenbergMarquardt<Eigen::Matrix<double, 5, 1>>(Decay{}, x, 5, {}, bounds);
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(x[1], 0.5);
  double best = 0, norm = 0;  // linear in x[0] there
  for (int i = 0; i < 5; ++i) {
    const double g = std::exp(-0.5 * i);
    best += g * (2 * std::exp(-0.3 * i) - 0.01 * (i % 2));
    norm += g * g;
  }
  EXPECT_NEAR(x[0], best / norm, 1e-9);
}

struct Fold {  // x^2 = 1 - 2 load: no root beyond half the load
  double load;
  template <class T>
  bool operator()(const T* x, T* f) const {
    f[0] = x[0] * x[0] - (1 - 2 * load);
    return true;
  }
};

struct Turn {  // x^3 + x = 30 load
  double load;
  template <class T>
  bool operator()(const T* x, T* f) const {
    f[0] = x[0] * x[0] * x[0] + x[0] - 30 * load;
    return true;
  }
};

TEST(Continue, FollowsAPathToItsEnd) {
  One x(0);
  ASSERT_TRUE(Continue([](double load) { return Turn{load}; }, x).ok());
  EXPECT_NEAR(x[0], 3, 1e-12);
}

TEST(Continue, NamesTheLoadWhereThePathEnds) {
  One x(1);
  const Outcome outcome = Continue([](double load) { return Fold{load}; }, x);
  EXPECT_FALSE(outcome.ok());
  EXPECT_THAT(outcome.why, HasSubstr("ends at 0.49"));
  EXPECT_NEAR(x[0], 0, 0.02);
}

}  // namespace
}  // namespace continuum::numerics
