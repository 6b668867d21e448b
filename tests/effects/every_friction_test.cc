// What every dry friction promises, of a joint or a tendon, and along the route of a cable.
#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

FrictionState<double> Draw(Quantities& in) {
  return {in.Normal(1, "rad"),  in.Normal(1, "rad/s"), std::abs(in.Normal(1, "N*m")),
          in.Normal(1, "N*m"),  in.Normal(1, "N*m"),   in.Uniform(0, 1, "s"),
          in.Uniform(0, 1, "J")};
}

template <class E>
struct EveryFriction : ::testing::Test {
  std::mt19937 rng{0};
};
TYPED_TEST_SUITE(EveryFriction, Frictions::Into<Types>, EffectName);

TYPED_TEST(EveryFriction, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const FrictionState<double> r = Draw(in);
    std::vector<Answer> all{{E::template Level<double>(r, p), "N*m"}};
    if constexpr (BiasedFrictionLaw<E>) all.push_back({E::template Bias<double>(p), "N*m"});
    if constexpr (requires { E::kGive; }) all.push_back({p[E::kGive], "rad"});
    if constexpr (requires { E::kLiteral; })
      all.push_back({E::template Literal<double>(r.v, p), "N*m"});
    return all;
  });
}

TYPED_TEST(EveryFriction, IsNeverNegative) {
  using E = TypeParam;
  for (unsigned k = 0; k < 100; ++k) {
    Quantities si(k, {});
    ASSERT_GE(E::template Level<double>(Draw(si), ActingParams<E>(this->rng)), 0);
  }
}

TYPED_TEST(EveryFriction, DoesNothingAtItsNull) {
  using E = TypeParam;
  EXPECT_EQ(E::template Level<double>({0.3, 0.2, 1, 0.7, -0.4, 2, 3}, NullParams<E>()), 0);
}

template <class E>
struct EveryBiasedFriction : ::testing::Test {
  std::mt19937 rng{0};
};
TYPED_TEST_SUITE(EveryBiasedFriction, BiasedFrictions::Into<Types>, EffectName);

TYPED_TEST(EveryBiasedFriction, OpposesEveryMotion) {
  using E = TypeParam;
  for (unsigned k = 0; k < 100; ++k) {
    const auto p = ActingParams<E>(this->rng);
    Quantities si(k, {});
    ASSERT_LE(std::abs(E::template Bias<double>(p)), E::template Level<double>(Draw(si), p));
  }
}

template <class E>
struct EveryFrictionAboveCoulomb : ::testing::Test {};
TYPED_TEST_SUITE(EveryFrictionAboveCoulomb, FrictionsAboveCoulomb::Into<Types>, EffectName);

TYPED_TEST(EveryFrictionAboveCoulomb, IsCoulombsWhereItsOtherParametersAreNull) {
  using E = TypeParam;
  auto p = NullParams<E>();
  p[E::kCoulombLevel] = 0.7;
  for (unsigned k = 0; k < 100; ++k) {
    Quantities si(k, {});
    ASSERT_EQ(E::template Level<double>(Draw(si), p), 0.7);
  }
}

template <class E>
struct EveryPath : ::testing::Test {
  std::mt19937 rng{0};
};
TYPED_TEST_SUITE(EveryPath, Paths::Into<Types>, EffectName);

TYPED_TEST(EveryPath, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const double wrap = in.Uniform(0, 1, "rad");
    std::vector<Answer> all;
    for (int option = 0; option < OptionsOf<E>(); ++option)
      all.push_back({E::template Band<double>(wrap, option, p), "1"});
    if constexpr (requires { E::kGive; }) all.push_back({p[E::kGive], "m"});
    return all;
  });
}

TYPED_TEST(EveryPath, IsNeverNegative) {
  using E = TypeParam;
  for (unsigned k = 0; k < 100; ++k) {
    const auto p = ActingParams<E>(this->rng);
    for (int option = 0; option < OptionsOf<E>(); ++option)
      ASSERT_GE(E::template Band<double>(0.03 * k, option, p), 0);
  }
}

TYPED_TEST(EveryPath, DoesNothingAtItsNull) {
  using E = TypeParam;
  for (int option = 0; option < OptionsOf<E>(); ++option)
    EXPECT_EQ(E::template Band<double>(0.5, option, NullParams<E>()), 0);
}

}  // namespace
}  // namespace continuum
