// What every law between an input and what it drives promises.
#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

// The unit of what a law at a tap sees.
constexpr std::string_view UnitAt(Tap tap) { return tap == Tap::kServoError ? "rad" : "input"; }

template <class E>
struct EveryGain : ::testing::Test {};
TYPED_TEST_SUITE(EveryGain, Gains::Into<Types>, EffectName);

TYPED_TEST(EveryGain, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const std::string unit(UnitAt(E::kTap));
    return std::vector<Answer>{{E::template Eval<double>(in.Normal(1, unit), p), unit}};
  });
}

TYPED_TEST(EveryGain, DoesNothingAtItsNull) {
  using E = TypeParam;
  EXPECT_EQ(E::template Eval<double>(0.3, NullParams<E>()), 0.3);
}

template <class E>
struct EveryFilter : ::testing::Test {
  std::mt19937 rng{0};
};
TYPED_TEST_SUITE(EveryFilter, Filters::Into<Types>, EffectName);

TYPED_TEST(EveryFilter, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const std::string unit(UnitAt(E::kTap));
    Vec<double, E::kStates.size()> z;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = in.Normal(1, E::kStates[i].unit);
    const double u = in.Normal(1, unit);
    const auto next = E::template Step<double>(z, u, in.In(0.01, "s"), p);
    std::vector<Answer> all{{E::template Eval<double>(u, z, p), unit}};
    for (std::size_t i = 0; i < z.size(); ++i)
      all.push_back({next[i], std::string(E::kStates[i].unit)});
    return all;
  });
}

// At constant u a step is two half steps.
TYPED_TEST(EveryFilter, StepsAsTwoHalves) {
  using E = TypeParam;
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

TYPED_TEST(EveryFilter, DoesNothingAtItsNull) {
  using E = TypeParam;
  const Vec<double, E::kStates.size()> z{};
  EXPECT_EQ(E::template Eval<double>(0.3, z, NullParams<E>()), 0.3);
}

template <class E>
struct EveryPull : ::testing::Test {};
TYPED_TEST_SUITE(EveryPull, Pulls::Into<Types>, EffectName);

TYPED_TEST(EveryPull, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const Pull<double> pull{in.Normal(3, "N"), in.Uniform(0, 3e3, "N/m")};
    return std::vector<Answer>{{E::template Eval<double>(pull, p), "N"}};
  });
}

TYPED_TEST(EveryPull, DoesNothingAtItsNull) {
  using E = TypeParam;
  for (const double tension : {-3.0, 0.0, 3.0}) {
    EXPECT_EQ(E::template Eval<double>(Pull<double>{tension, 1e4}, NullParams<E>()), tension);
  }
}

template <class E>
struct EverySupply : ::testing::Test {};
TYPED_TEST_SUITE(EverySupply, Supplies::Into<Types>, EffectName);

TYPED_TEST(EverySupply, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    return std::vector<Answer>{{E::template Share<double>(in.Uniform(0, 3, "N*m"), p), "1"}};
  });
}

TYPED_TEST(EverySupply, DoesNothingAtItsNull) {
  using E = TypeParam;
  EXPECT_EQ(E::template Share<double>(0.3, NullParams<E>()), 1);
}

// None turns an actuator round, makes it stronger, or gives more where more is drawn.
TYPED_TEST(EverySupply, GivesEachLessTheMoreIsDrawn) {
  using E = TypeParam;
  std::mt19937 rng{0};
  for (int k = 0; k < 100; ++k) {
    const auto p = RandomParams<E>(rng);
    double last = 1;
    for (double load = 0; load < 1e3; load = 0.1 + 2 * load) {
      const double share = E::template Share<double>(load, p);
      EXPECT_GE(share, 0);
      EXPECT_LE(share, last);
      last = share;
    }
  }
}

}  // namespace
}  // namespace continuum
