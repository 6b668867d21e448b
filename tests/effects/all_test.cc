// Laws that every effect in effects/all.h obeys. Effects are not listed here.
#include "effects/all.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

namespace continuum {
namespace {

// The factor that a quantity takes when the units of mass, length and time are rescaled.
struct Units3 {
  double m, l, t;
};
double Factor(std::string_view unit, Units3 s) {
  double out = 1, sign = 1;
  for (std::size_t i = 0; i <= unit.size();) {
    const std::size_t j = std::min(unit.find_first_of("*/", i), unit.size());
    std::string_view u = unit.substr(i, j - i);
    double power = 1;
    if (const auto caret = u.find('^'); caret != u.npos) {
      power = u[caret + 1] - '0';
      u = u.substr(0, caret);
    }
    double f = 0;
    if (u == "1" || u == "rad" || u == "input" || u == "output") f = 1;
    if (u == "kg") f = s.m;
    if (u == "m") f = s.l;
    if (u == "s") f = s.t;
    if (u == "N") f = s.m * s.l / (s.t * s.t);
    if (u == "J") f = s.m * s.l * s.l / (s.t * s.t);
    if (f == 0) ADD_FAILURE() << "unknown unit '" << u << "'";
    out *= std::pow(f, sign * power);
    if (j < unit.size()) sign = unit[j] == '/' ? -1 : 1;
    i = j + 1;
  }
  return out;
}

template <class E>
ParamsOf<E, double> RandomParams(std::mt19937& rng) {
  std::normal_distribution<double> n;
  ParamsOf<E, double> p;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = std::clamp(E::kParams[i].initial * std::exp(0.3 * n(rng)), E::kParams[i].lower,
                      E::kParams[i].upper);
  }
  return p;
}

template <class E>
struct EveryEffect : ::testing::Test {
  std::mt19937 rng{0};
};
template <class... E>
using Types = ::testing::Types<E...>;
struct Name {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::kName);
  }
};
TYPED_TEST_SUITE(EveryEffect, All::Into<Types>, Name);

TYPED_TEST(EveryEffect, HasACompleteCard) {
  using E = TypeParam;
  std::set<std::string_view> names;
  EXPECT_FALSE(E::kSummary.empty());
  EXPECT_FALSE(E::kPlaces.empty());
  for (const Param& p : E::kParams) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_LE(p.lower, p.initial) << p.name;
    EXPECT_LE(p.initial, p.upper) << p.name;
    EXPECT_LT(p.lower, p.upper) << p.name;
    if (!std::isnan(p.null)) {
      EXPECT_TRUE(p.lower <= p.null && p.null <= p.upper) << p.name;
    }
    Factor(p.unit, {1, 1, 1});
  }
  std::ifstream bib(std::string(CONTINUUM_SOURCE) + "/plugin/effects/references.bib");
  std::stringstream text;
  text << bib.rdbuf();
  EXPECT_NE(text.str().find("{" + std::string(E::kSource) + ","), std::string::npos) << E::kSource;
}

TYPED_TEST(EveryEffect, NeverCreatesEnergyAsAForce) {
  using E = TypeParam;
  if constexpr (ForceLaw<E>) {
    constexpr int kZ = static_cast<int>(E::kStates.size()), kN = 2 + kZ;
    using Gradient = Eigen::Matrix<double, kN, 1>;
    using Dual = Eigen::AutoDiffScalar<Gradient>;
    std::normal_distribution<double> n;
    for (int k = 0; k < 1000; ++k) {
      const auto p = RandomParams<E>(this->rng);
      ParamsOf<E, Dual> dual;
      for (std::size_t i = 0; i < p.size(); ++i) dual[i] = Dual(p[i]);
      Vec<Dual, kZ> z;
      const Dual x(n(this->rng), kN, 0), v(n(this->rng), kN, 1);
      std::uniform_real_distribution<double> unit(-1, 1);
      for (int i = 0; i < kZ; ++i) z[i] = Dual(unit(this->rng), kN, 2 + i);
      const auto r = E::template Eval<Dual>({x, v}, z, dual);
      double rate = r.stored.derivatives()[0] * v.value();
      for (int i = 0; i < kZ; ++i) rate += r.stored.derivatives()[2 + i] * r.zdot[i].value();
      const double power = r.force.value() * v.value();
      ASSERT_GE(power - rate, -1e-12 * (1 + std::abs(power)));
    }
  }
}

// Step at constant v against Runge-Kutta on Eval's rates.
TYPED_TEST(EveryEffect, StepsItsStatesExactly) {
  using E = TypeParam;
  if constexpr (ForceLaw<E>) {
    constexpr std::size_t kZ = E::kStates.size();
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int k = 0; k < 50; ++k) {
      const auto p = RandomParams<E>(this->rng);
      Vec<double, kZ> z;
      for (double& value : z) value = unit(this->rng);
      const Port<double> q{0, 0.02 * unit(this->rng)};
      const double h = 0.01;
      const auto exact = E::template Step<double>(z, q, h, p);
      const auto rate = [&](const Vec<double, kZ>& s) {
        return E::template Eval<double>(q, s, p).zdot;
      };
      const int steps = 2000;
      for (int i = 0; i < steps; ++i) {
        const double dt = h / steps;
        const auto a = rate(z);
        auto mid = z;
        for (std::size_t j = 0; j < kZ; ++j) mid[j] += dt / 2 * a[j];
        const auto b = rate(mid);
        for (std::size_t j = 0; j < kZ; ++j) z[j] += dt * b[j];
      }
      for (std::size_t j = 0; j < kZ; ++j)
        EXPECT_NEAR(z[j], exact[j], 1e-6);  // midpoint rule: dt² error
    }
  }
}

// At constant u a step is two half steps.
TYPED_TEST(EveryEffect, StepsItsFilterAsTwoHalves) {
  using E = TypeParam;
  if constexpr (FilterLaw<E>) {
    std::normal_distribution<double> n;
    for (int k = 0; k < 100; ++k) {
      const auto p = RandomParams<E>(this->rng);
      Vec<double, E::kStates.size()> z;
      for (double& value : z) value = n(this->rng);
      const double u = n(this->rng), h = 0.01;
      const auto whole = E::template Step<double>(z, u, h, p);
      const auto half = E::template Step<double>(z, u, h / 2, p);
      const auto twice = E::template Step<double>(half, u, h / 2, p);
      for (std::size_t i = 0; i < z.size(); ++i) {
        EXPECT_NEAR(whole[i], twice[i], 1e-12 * (1 + std::abs(whole[i])));
      }
    }
  }
}

TYPED_TEST(EveryEffect, IsConsistentInItsUnitsAsFriction) {
  using E = TypeParam;
  if constexpr (FrictionLaw<E>) {
    const Units3 s{1.7, 0.6, 2.3};
    std::normal_distribution<double> n;
    for (int k = 0; k < 100; ++k) {
      const auto p = RandomParams<E>(this->rng);
      auto w = p;
      for (std::size_t i = 0; i < w.size(); ++i) w[i] *= Factor(E::kParams[i].unit, s);
      const Rubbing<double> r{n(this->rng), n(this->rng), std::abs(n(this->rng))};
      const Rubbing<double> q{r.q, r.v / s.t, r.load * Factor("N*m", s)};
      const double a = E::template Level<double>(r, p), b = E::template Level<double>(q, w);
      ASSERT_GE(a, 0);
      if constexpr (BiasedFrictionLaw<E>) {
        const double bias = E::template Bias<double>(p);
        ASSERT_NEAR(E::template Bias<double>(w), bias * Factor("N*m", s), 1e-9 * std::abs(b));
        ASSERT_LE(std::abs(bias), a);  // it opposes every motion
      }
      ASSERT_NEAR(b, a * Factor("N*m", s), 1e-9 * std::abs(b));
    }
  }
}

TYPED_TEST(EveryEffect, IsConsistentInItsUnitsAsASegment) {
  using E = TypeParam;
  if constexpr (SegmentLaw<E>) {
    const Units3 s{1.7, 0.6, 2.3};
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int k = 0; k < 100; ++k) {
      const auto p = RandomParams<E>(this->rng);
      auto w = p;
      for (std::size_t i = 0; i < w.size(); ++i) w[i] *= Factor(E::kParams[i].unit, s);
      Vec<double, 3> x, v, pressure, x2, v2, pressure2;
      for (int i = 0; i < 3; ++i) {
        x[i] = 0.02 * unit(this->rng), v[i] = unit(this->rng), pressure[i] = 4e4 * unit(this->rng);
        x2[i] = x[i] * s.l, v2[i] = v[i] * s.l / s.t,
        pressure2[i] = pressure[i] * Factor("N/m^2", s);
      }
      const auto a = E::template Eval<double>(x, v, pressure, 0, p);
      const auto b = E::template Eval<double>(x2, v2, pressure2, 0, w);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(b[i], a[i] * Factor("N", s), 1e-12);
    }
  }
}

// An element whose attributes are all 0.37. A lag and a delay of 0 are those of an actuator that
// has none.
struct Untouched {
  std::map<std::string, double, std::less<>> values;
  double& At(std::string_view name) {
    return values.try_emplace(std::string(name), 0.37).first->second;
  }
  double Get(std::string_view name) { return At(name); }
  void Set(std::string_view name, double value) {
    if ((name == "lag" || name == "delay") && value == 0) return;
    At(name) = value;
  }
  void Add(std::string_view name, double value) { At(name) += value; }
  void Scale(std::string_view name, double factor) { At(name) *= factor; }
};

TYPED_TEST(EveryEffect, DoesNothingAtItsNull) {
  using E = TypeParam;
  ParamsOf<E, double> p;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = std::isnan(E::kParams[i].null) ? E::kParams[i].initial : E::kParams[i].null;
  }
  if constexpr (FrictionLaw<E>) {
    EXPECT_EQ(E::template Level<double>({0.3, 0.2, 1}, p), 0);
  }
  if constexpr (SegmentLaw<E>) {
    for (const double force :
         E::template Eval<double>({.1, .2, .3}, {.1, .2, .3}, {1, 2, 3}, 0, p)) {
      EXPECT_EQ(force, 0);
    }
  }
  if constexpr (PathLaw<E>) {
    EXPECT_EQ(E::template Band<double>(0.5, 0, p), 0);
  }
  if constexpr (GainLaw<E>) {
    EXPECT_EQ(E::template Eval<double>(0.3, p), 0.3);
  }
  if constexpr (FilterLaw<E>) {
    Vec<double, E::kStates.size()> z{};
    EXPECT_EQ(E::template Eval<double>(0.3, z, p), 0.3);
  }
  if constexpr (PullLaw<E>) {
    for (const double tension : {-3.0, 0.0, 3.0}) {
      EXPECT_EQ(E::template Eval<double>(Pull<double>{tension, 1e4}, p), tension);
    }
  }
  if constexpr (ScalarMeasureLaw<E>) {
    EXPECT_EQ(E::template Eval<double>([](double t) { return std::exp(t); }, 0.7, p),
              std::exp(0.7));
  }
  if constexpr (VectorMeasureLaw<E>) {
    const auto y = [](double t) { return Vec<double, 3>{t, 2 * t, -t}; };
    EXPECT_EQ(E::template Eval<double>(y, 0.7, p), y(0.7));
  }
  if constexpr (EditLaw<E>) {
    Untouched element;
    if (std::none_of(E::kParams.begin(), E::kParams.end(),
                     [](const Param& param) { return std::isnan(param.null); })) {
      E::Apply(element, p);
      for (const auto& [name, value] : element.values) EXPECT_EQ(value, 0.37) << name;
    }
  }
  if constexpr (ForceLaw<E>) {
    Vec<double, E::kStates.size()> z{};
    EXPECT_EQ(E::template Eval<double>({0.3, 0.2}, z, p).force, 0);
  }
}

}  // namespace
}  // namespace continuum
