#include "sim/numerics/portable_random.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

TEST(Random, RepeatsItsSequence) {
  Random random(1);
  EXPECT_EQ(random.Uniform(), 0.13387664401253269);
  EXPECT_DOUBLE_EQ(random.Normal(), -1.9030114103063831);
}

TEST(LibstdcxxRandom, RepeatsItsSequences) {
  Random32 small(1);
  EXPECT_EQ(small.Uniform(), 0.99718480823026556);
  EXPECT_DOUBLE_EQ(small.Normal(), -1.6017209952909703);
  Random64 large(1);
  EXPECT_EQ(large.Uniform(), 0.13387664401253274);
  EXPECT_DOUBLE_EQ(large.Normal(), -0.1480007443985612);
}

TEST(LibstdcxxRandom, NormalsComeInPairs) {
  Random64 random(1), again(1);
  const double first = random.Normal();
  EXPECT_NE(random.Normal(), first);
  EXPECT_EQ(again.Normal(), first);
  again.BeginPair();
  random.BeginPair();
  EXPECT_EQ(again.Normal(), random.Normal());
}

#ifdef __GLIBCXX__
template <class Engine>
void ExpectAsTheLibrary() {
  Engine engine(7);
  LibstdcxxRandom<Engine> random(7);
  std::uniform_real_distribution<double> unit(0, 1), wide(-3, 60e3);
  std::normal_distribution<double> normal(0, 0.041e-3);
  for (int k = 0; k < 10000; ++k) {
    ASSERT_EQ(random.Uniform(), unit(engine));
    ASSERT_EQ(random.Uniform(-3, 60e3), wide(engine));
    ASSERT_EQ(0.041e-3 * random.Normal(), normal(engine));
    ASSERT_EQ(random.Bits(), engine());
  }
}

TEST(LibstdcxxRandom, DrawsWhatTheLibraryDraws) {
  ExpectAsTheLibrary<std::mt19937>();
  ExpectAsTheLibrary<std::mt19937_64>();
}
#endif

}  // namespace
}  // namespace continuum
