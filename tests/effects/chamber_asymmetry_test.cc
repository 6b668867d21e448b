#include "effects/chamber_asymmetry.h"

#include <random>

#include <gtest/gtest.h>

#include "effects/pcc_segment.h"

namespace continuum {
namespace {

using Three = Vec<double, 3>;

// With the segment's own centre at (1, 2) mm and 0.5 mm more in both directions.
TEST(ChamberAsymmetryLaw, BesideASegmentItIsTheSegmentWithItsCentreMoved) {
  PccSegmentLaw::Params<double> segment;
  for (std::size_t i = 0; i < segment.size(); ++i) segment[i] = PccSegmentLaw::kParams[i].initial;
  segment[3] = 1e-3, segment[4] = 2e-3;
  auto moved = segment;
  moved[3] += 5e-4, moved[4] -= 5e-4;
  const ChamberAsymmetry::Params<double> p{segment[1], segment[5], 5e-4, -5e-4};
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100; ++k) {
    const Three delta{0.05 * unit(rng), 0.05 * unit(rng), 0.02 * unit(rng)};
    const Three rate{unit(rng), unit(rng), unit(rng)};
    const Three pressure{5e4 * (1 + unit(rng)), 5e4 * (1 + unit(rng)), 5e4 * (1 + unit(rng))};
    for (const int actuation : {0, 1}) {
      const Three whole = PccSegmentLaw::Eval<double>(delta, rate, pressure, actuation, moved);
      const Three part = PccSegmentLaw::Eval<double>(delta, rate, pressure, actuation, segment);
      const Three more = ChamberAsymmetry::Eval<double>(delta, rate, pressure, actuation, p);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(part[i] + more[i], whole[i], 1e-13);
    }
  }
}

TEST(ChamberAsymmetryLaw, EqualPressuresBendTowardTheMovedCentre) {
  const Three force =
      ChamberAsymmetry::Eval<double>({}, {}, {1e4, 1e4, 1e4}, 1, {0.05, 31e-6, 5e-4, -2e-4});
  const double push = 3 * 31e-6 * 1e4 / 0.05;
  EXPECT_NEAR(force[0], 5e-4 * push, 1e-16);
  EXPECT_NEAR(force[1], -2e-4 * push, 1e-16);
  EXPECT_EQ(force[2], 0);
}

}  // namespace
}  // namespace continuum
