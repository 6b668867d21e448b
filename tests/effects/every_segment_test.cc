// What every law of soft segments promises.
#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

template <class E>
struct EverySegment : ::testing::Test {};
TYPED_TEST_SUITE(EverySegment, Segments::Into<Types>, EffectName);

TYPED_TEST(EverySegment, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>([](Quantities& in, const ParamsOf<E, double>& p) {
    Vec<double, 3> x, v, pressure;
    for (int i = 0; i < 3; ++i) {
      x[i] = in.Uniform(-0.02, 0.02, "m");
      v[i] = in.Uniform(-1, 1, "m/s");
      pressure[i] = in.Uniform(-4e4, 4e4, "N/m^2");
    }
    std::vector<Answer> all{{E::template Segment<double>(p).d, "m"}};
    for (int option = 0; option < OptionsOf<E>(); ++option) {
      for (const double force : E::template Eval<double>(x, v, pressure, option, p))
        all.push_back({force, "N"});
    }
    return all;
  });
}

TYPED_TEST(EverySegment, HasTheArcRadiusOfItsCard) {
  using E = TypeParam;
  std::mt19937 rng{0};
  const auto p = ActingParams<E>(rng);
  EXPECT_EQ(E::template Segment<double>(p).d, p[E::kArcRadius]);
}

TYPED_TEST(EverySegment, DoesNothingAtItsNull) {
  using E = TypeParam;
  for (int option = 0; option < OptionsOf<E>(); ++option) {
    for (const double force :
         E::template Eval<double>({.1, .2, .3}, {.1, .2, .3}, {1, 2, 3}, option, NullParams<E>())) {
      EXPECT_EQ(force, 0);
    }
  }
}

}  // namespace
}  // namespace continuum
