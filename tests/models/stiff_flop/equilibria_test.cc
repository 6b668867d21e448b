#include "models/stiff_flop/equilibria.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/published.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;
using statics::Branch;

const Method kPlain = Method::Parse("hooke+fixed+fixed", Direction::kForward);

Case Pushed(const Vector3d& force, const Vector3d& pressure = Vector3d::Zero()) {
  return {"", pressure, {force, {0, 9.81, 0}}};
}

double EnergyOf(const Case& row) {
  const Solution s = SolveForward(Published(), kPlain, row, false);
  EXPECT_EQ(s.status, Status::kOk);
  return Describe(Published(), kPlain, Direction::kForward, row, s).energy;
}

// The section of fixed+fixed has a potential: then the energy's slope by the force is minus the way
// of where it acts.
TEST(StiffFlopDetails, TheEnergysSlopeIsTheWayOfTheForce) {
  const Module module = Published();
  const Case row = Pushed({0.1, -0.2, 0.05}, {2e4, 5e3, 0});
  const Solution s = SolveForward(module, kPlain, row, false);
  ASSERT_EQ(s.status, Status::kOk);
  const Vector3d way = s.tip + module.l_fs * s.tangent - Vector3d(0, module.l + module.l_fs, 0);
  for (int i = 0; i < 3; ++i) {
    const Vector3d step = 1e-3 * Vector3d::Unit(i);
    const double slope = (EnergyOf(Pushed(row.load.force + step, row.given)) -
                          EnergyOf(Pushed(row.load.force - step, row.given))) /
                         2e-3;
    EXPECT_NEAR(slope, -way[i], 2e-3 * module.l);  // 32 pieces stand for the rod
  }
}

TEST(StiffFlopDetails, TheBaseCarriesTheDeadLoads) {
  const Module module = Published();
  const Case row = Pushed({0.1, -0.2, 0.05}, {2e4, 5e3, 0});
  const Solution s = SolveForward(module, kPlain, row, false);
  const statics::Details details = Describe(module, kPlain, Direction::kForward, row, s);
  const Vector3d weight(0, (module.m + module.m_fs) * 9.81, 0);
  EXPECT_LT((details.force - row.load.force - weight).norm(), 1e-12);
  EXPECT_LT((details.moment - BaseMoment(module, kPlain, row)).norm(), 1e-12);
  EXPECT_LT((details.tip * Vector3d::UnitY() - s.tangent).norm(), 1e-9);
  // The moment once more, from places along the axis.
  Vector3d moment = (s.tip + module.l_fs * s.tangent).cross(row.load.force);
  moment += (s.tip + 0.5 * module.l_fs * s.tangent).cross(module.m_fs * row.load.gravity);
  const auto places = Places(module, kPlain, row, s);
  const auto pieces = static_cast<double>(places.size() - 1);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Vector3d middle = 0.5 * (places[i].point + places[i + 1].point);
    moment += middle.cross(module.m / pieces * row.load.gravity);
  }
  EXPECT_LT((details.moment - moment).norm(), 1e-3 * moment.norm());
}

// An axial push beyond buckling, with a hint: the bent shape of either side, and the saddle
// between.
TEST(StiffFlopEquilibria, APushHasTwoBentShapesAndASaddle) {
  const Module module = Published();
  const Case row = Pushed({0.01, -1.5, 0});
  const Solution own = SolveForward(module, kPlain, row, false);
  ASSERT_EQ(own.status, Status::kOk);
  const auto list = Equilibria(module, kPlain, row, own);
  ASSERT_GE(list.size(), 3u);
  int sum = 0, rising = 0, stable = 0;
  double before = -1e9;
  for (const Solution& s : list) {
    sum += s.stability.unstable_directions % 2 == 0 ? 1 : -1;
    rising += s.stability.branch == Branch::kRising ? 1 : 0;
    stable += s.stability.stable() ? 1 : 0;
    const double energy = Describe(module, kPlain, Direction::kForward, row, s).energy;
    EXPECT_GE(energy, before);
    before = energy;
  }
  EXPECT_EQ(sum, 1);
  EXPECT_EQ(rising, 1);
  EXPECT_EQ(stable, 1);  // the other side gives way out of the plane
  EXPECT_TRUE(list.front().stability.stable());
}

}  // namespace
}  // namespace continuum::stiff_flop
