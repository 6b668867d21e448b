#include "models/statics/equilibria.h"

#include <gmock/gmock.h>

namespace continuum::statics {
namespace {

using Vector1 = Eigen::Matrix<double, 1, 1>;

// x^3 - x, with the roots -1, 0, 1.
struct Cubic {
  template <class T>
  bool operator()(const T* x, T* f) const {
    f[0] = x[0] * x[0] * x[0] - x[0];
    return true;
  }
};

Roots<Vector1> RootsWithin(long systems) {
  SearchOptions options;
  options.most_systems = systems;
  const auto draw = [](Random& random) { return Vector1(4 * random.Uniform() - 2); };
  const auto energy = [](const Vector1& x) { return x[0]; };
  return FindRoots<Vector1>(Cubic{}, {Vector1(0.9)}, draw, energy, options);
}

TEST(Equilibria, AllRootsOfACubicAreFound) {
  const auto roots = RootsWithin(100000);
  EXPECT_EQ(roots.x.size(), 3U);
  EXPECT_EQ(roots.gave_up, "");
}

TEST(Equilibria, ASearchThatCostsTooMuchSaysSoAndKeepsWhatItHas) {
  const auto roots = RootsWithin(8);
  EXPECT_GE(roots.x.size(), 1U);
  EXPECT_LT(roots.x.size(), 3U);
  EXPECT_THAT(roots.gave_up, testing::HasSubstr("given up after 9 linear systems"));
  EXPECT_THAT(roots.gave_up, testing::HasSubstr("there may be others"));
  struct Found {
    numerics::Outcome outcome;
    Stability stability;
    double x = 0;
  };
  const auto near = [](const Vector1& x) {
    Found found{{}, {}, x[0]};
    found.outcome.status = numerics::Status::kOk;
    return found;
  };
  const auto list = ByEnergy(
      Found{}, roots, near, [](const Found& a, const Found& b) { return a.x == b.x; },
      [](const Found& a) { return a.x; });
  ASSERT_EQ(list.size(), roots.x.size() + 1);
  EXPECT_FALSE(list.back().outcome.ok());
  EXPECT_EQ(list.back().outcome.why, roots.gave_up);
}

}  // namespace
}  // namespace continuum::statics
