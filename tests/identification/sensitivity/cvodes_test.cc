#include "identification/sensitivity/cvodes.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"

namespace continuum {
namespace {

// m x'' = −k x − c x' of unit mass and its sensitivities for k and c.
Ode Oscillator(double k, double c) {
  Ode ode;
  ode.size = 2;
  ode.parameters = 2;
  ode.rate = [=](double, const double* y, double* rate) {
    rate[0] = y[1];
    rate[1] = -k * y[0] - c * y[1];
  };
  ode.sensitivity = [=](double, const double* y, const double*, const Ode::States& s,
                        const Ode::States& rates) {
    for (int p = 0; p < 2; ++p) {
      rates[p][0] = s[p][1];
      rates[p][1] = -k * s[p][0] - c * s[p][1] - y[p];
    }
  };
  return ode;
}

// From x = 1 at rest.
double Position(double k, double c, double t) {
  const double w = std::sqrt(k - c * c / 4);
  return std::exp(-c * t / 2) * (std::cos(w * t) + c / (2 * w) * std::sin(w * t));
}

class CvodesTest : public ::testing::TestWithParam<bool> {
 protected:
  SolverOptions how_{1e-9, 1e-12, GetParam()};
};

// Differences of the closed form to 1e-9; errors of the solver pile up over 30 radians.
TEST_P(CvodesTest, FollowsAnOscillatorAndItsSensitivities) {
  constexpr double k = 9, c = 0.4, kStep = 1e-5;
  Cvodes solver(Oscillator(k, c), how_);
  solver.Start(0, std::vector<double>{1, 0});
  for (double t = 0.25; t <= 10; t += 0.25) {
    ASSERT_TRUE(solver.Advance(t, 10)) << solver.failure();
    EXPECT_NEAR(solver.y()[0], Position(k, c, t), 1e-6);
    EXPECT_NEAR(solver.s(0)[0],
                (Position(k + kStep, c, t) - Position(k - kStep, c, t)) / (2 * kStep), 1e-6);
    EXPECT_NEAR(solver.s(1)[0],
                (Position(k, c + kStep, t) - Position(k, c - kStep, t)) / (2 * kStep), 1e-6);
  }
}

// ∂f/∂y s and ∂f/∂p both matter, and so do their signs: what the test above has to see.
TEST_P(CvodesTest, SensitivitiesNeedEveryTerm) {
  constexpr double k = 9, c = 0.4, t = 2, kStep = 1e-5;
  const double expected = (Position(k, c + kStep, t) - Position(k, c - kStep, t)) / (2 * kStep);
  const auto found = [&](double own, double spring, double damper) {
    Ode ode = Oscillator(k, c);
    ode.sensitivity = [=](double, const double* y, const double*, const Ode::States& s,
                          const Ode::States& rates) {
      for (int p = 0; p < 2; ++p) {
        rates[p][0] = s[p][1];
        rates[p][1] = -spring * k * s[p][0] - damper * c * s[p][1] - own * y[p];
      }
    };
    Cvodes solver(ode, how_);
    solver.Start(0, std::vector<double>{1, 0});
    EXPECT_TRUE(solver.Advance(t, t));
    return solver.s(1)[0];
  };
  EXPECT_NEAR(found(1, 1, 1), expected, 1e-6);
  for (const double changed : {0.0, -1.0}) {
    EXPECT_GT(std::abs(found(changed, 1, 1) - expected), 0.05);
    EXPECT_GT(std::abs(found(1, changed, 1) - expected), 0.05);
    EXPECT_GT(std::abs(found(1, 1, changed) - expected), 0.05);
  }
}

TEST_P(CvodesTest, GoesOnFromWhereItWasStartedAnew) {
  Cvodes once(Oscillator(4, 0.1), how_), twice(Oscillator(4, 0.1), how_);
  once.Start(0, std::vector<double>{1, 0});
  twice.Start(0, std::vector<double>{1, 0});
  ASSERT_TRUE(once.Advance(2, 2));
  ASSERT_TRUE(twice.Advance(1, 1));
  const std::vector<double> y(twice.y(), twice.y() + 2);
  std::vector<double> s(twice.s(0), twice.s(0) + 2);
  s.insert(s.end(), twice.s(1), twice.s(1) + 2);
  twice.Start(1, y, s);
  ASSERT_TRUE(twice.Advance(2, 2));
  EXPECT_NEAR(twice.y()[0], once.y()[0], 1e-7);
  EXPECT_NEAR(twice.s(0)[1], once.s(0)[1], 1e-7);
  EXPECT_GT(twice.work().rates, twice.work().steps);
}

TEST_P(CvodesTest, NeverLooksBeyondTheTimeAtWhichTheEquationMayChange) {
  double latest = 0;
  Ode ode;
  ode.size = 1;
  ode.rate = [&](double t, const double*, double* rate) {
    latest = std::max(latest, t), *rate = 1;
  };
  Cvodes solver(ode, how_);
  solver.Start(0, std::vector<double>{0});
  ASSERT_TRUE(solver.Advance(0.5, 1));
  ASSERT_TRUE(solver.Advance(1, 1));
  EXPECT_LE(latest, 1 + 1e-12);
  EXPECT_NEAR(solver.y()[0], 1, 1e-9);
}

TEST_P(CvodesTest, SaysWhyItCannotGoOn) {
  Ode ode;
  ode.size = 1;
  ode.rate = [](double t, const double*, double* rate) {
    *rate = t < 0.5 ? 1 : std::numeric_limits<double>::quiet_NaN();
  };
  Cvodes solver(ode, how_);
  solver.Start(0, std::vector<double>{0});
  EXPECT_FALSE(solver.Advance(1, 1));
  EXPECT_THAT(solver.failure(), ::testing::HasSubstr("CV_"));
}

TEST_P(CvodesTest, PassesOnWhatAnEquationThrows) {
  Ode ode;
  ode.size = 1;
  ode.rate = [](double, const double*, double*) { throw Error::Job("out of range"); };
  Cvodes solver(ode, how_);
  solver.Start(0, std::vector<double>{0});
  EXPECT_THROW(solver.Advance(1, 1), Error);
}

INSTANTIATE_TEST_SUITE_P(Method, CvodesTest, ::testing::Bool(), [](const auto& param) {
  return param.param ? std::string("Bdf") : std::string("Adams");
});

}  // namespace
}  // namespace continuum
