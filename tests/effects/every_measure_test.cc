// What every error of a sensor or a clock promises.
#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

template <class E>
struct EveryScalarMeasure : ::testing::Test {};
TYPED_TEST_SUITE(EveryScalarMeasure, ScalarMeasures::Into<Types>, EffectName);

TYPED_TEST(EveryScalarMeasure, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const double second = in.In(1, "s"), size = in.In(1, "output");
    const auto y = [=](double t) { return size * std::exp(t / second); };
    const double t = in.Uniform(0, 1, "s");
    return std::vector<Answer>{{E::template Eval<double>(y, t, p), "output"}};
  });
}

TYPED_TEST(EveryScalarMeasure, DoesNothingAtItsNull) {
  using E = TypeParam;
  EXPECT_EQ(E::template Eval<double>([](double t) { return std::exp(t); }, 0.7, NullParams<E>()),
            std::exp(0.7));
}

template <class E>
struct EveryVectorMeasure : ::testing::Test {};
TYPED_TEST_SUITE(EveryVectorMeasure, VectorMeasures::Into<Types>, EffectName);

TYPED_TEST(EveryVectorMeasure, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    const double second = in.In(1, "s"), size = in.In(1, "output");
    const auto y = [=](double t) {
      return Vec<double, 3>{size * t / second, size * std::exp(t / second), -size};
    };
    std::vector<Answer> all;
    for (const double value : E::template Eval<double>(y, in.Uniform(0, 1, "s"), p))
      all.push_back({value, "output"});
    return all;
  });
}

TYPED_TEST(EveryVectorMeasure, DoesNothingAtItsNull) {
  using E = TypeParam;
  const auto y = [](double t) { return Vec<double, 3>{t, 2 * t, -t}; };
  EXPECT_EQ(E::template Eval<double>(y, 0.7, NullParams<E>()), y(0.7));
}

}  // namespace
}  // namespace continuum
