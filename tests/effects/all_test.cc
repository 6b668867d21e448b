// What every effect of effects/all.h has to have. Effects are not listed here.
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

template <class E, class... Other>
constexpr bool IsOneOf(List<Other...>*) {
  return (std::same_as<E, Other> || ...);
}

// How many typed suites test a law.
template <class E, class... Lists>
constexpr int kSuites = (0 + ... + IsOneOf<E>(static_cast<Lists*>(nullptr)));

template <class E>
struct EveryEffect : ::testing::Test {};
TYPED_TEST_SUITE(EveryEffect, All::Into<Types>, EffectName);

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
    EXPECT_EQ(FactorOf(p.unit, {}), 1) << p.name;
  }
  std::ifstream bib(std::string(CONTINUUM_SOURCE) + "/plugin/effects/references.bib");
  std::stringstream text;
  text << bib.rdbuf();
  EXPECT_NE(text.str().find("{" + std::string(E::kSource) + ","), std::string::npos) << E::kSource;
}

TYPED_TEST(EveryEffect, IsTestedByASuiteOfItsKind) {
  EXPECT_GE((kSuites<TypeParam, Forces, Frictions, Paths, Segments, Gains, Filters, Pulls, Supplies,
                     ScalarMeasures, VectorMeasures, Edits>),
            1);
}

}  // namespace
}  // namespace continuum
