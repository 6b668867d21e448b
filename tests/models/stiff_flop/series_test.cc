#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "models/stiff_flop/details.h"
#include "models/stiff_flop/equilibria.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"
#include "models/stiff_flop/published.h"
#include "models/stiff_flop/reach.h"
#include "models/stiff_flop/response.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

const Method kPlain = Method::Parse("hooke+fixed+fixed", Direction::kForward);
const Method kFull = Method::Parse("hooke+general+constant", Direction::kForward);

Module Bare() {
  Module module = Published();
  module.l_fs = module.m_fs = 0;
  return module;
}

// A stiff one with a mount, and a soft one with four lines on it.
ModuleSeries Unlike() {
  Module lower = Published(), upper = Published();
  lower.l_fs = 8e-3;
  lower.m_fs = 5e-3;
  upper.l = 35e-3;
  upper.E = 0.7e5;
  upper.lines = EvenLines(4);
  return ModuleSeries({lower, upper});
}

Case Loaded(std::initializer_list<double> pressures, const Vector3d& force,
            const Vector3d& gravity = {0, 9.81, 0}) {
  return {"",
          VectorXd::Map(pressures.begin(), static_cast<Eigen::Index>(pressures.size())),
          {force, gravity}};
}

Case UnlikeCase() { return Loaded({2e4, 5e3, 0, 0, 1e4, 0, 2e3}, {0.03, -0.04, 0.02}); }

Vector3d Turned(const Vector3d& v, double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitY()) * v;
}

TEST(StiffFlopSeries, TwoEqualModulesAreOneOfTwiceTheLength) {
  Module twice = Bare();
  twice.l *= 2;
  twice.m *= 2;
  for (const Method& method : {kPlain, kFull}) {
    const Vector3d force(0.02, 0.01, -0.015);
    const Solution one = SolveForward(twice, method, Loaded({3e4, 1e4, 0}, force), false);
    const Solution two = SolveForward(ModuleSeries({Bare(), Bare()}), method,
                                      Loaded({3e4, 1e4, 0, 3e4, 1e4, 0}, force), false);
    ASSERT_EQ(two.status, Status::kOk) << two.outcome.why;
    EXPECT_LT((one.tip - two.tip).norm(), 1e-9 * twice.l);
    EXPECT_LT((one.tangent - two.tangent).norm(), 1e-8);
  }
}

TEST(StiffFlopSeries, BucklesAsOneOfTwiceTheLength) {
  Module twice = Bare();
  twice.l *= 2;
  twice.m *= 2;
  const Vector3d push(0, -0.9, 0);  // pi^2/4 EI/L^2 is 0.6 N, and the weight pulls
  const Solution one = SolveForward(twice, kPlain, Loaded({0, 0, 0}, push), false);
  const Solution two =
      SolveForward(ModuleSeries({Bare(), Bare()}), kPlain, Loaded({0, 0, 0, 0, 0, 0}, push), false);
  ASSERT_EQ(one.status, Status::kOk) << one.outcome.why;
  ASSERT_EQ(two.status, Status::kOk) << two.outcome.why;
  EXPECT_EQ(two.stability.branch, statics::Branch::kSymmetric);
  EXPECT_TRUE(two.stability.stable());
  EXPECT_GT(std::hypot(two.tip.x(), two.tip.z()), 0.3 * twice.l);
  EXPECT_NEAR(one.tip.y(), two.tip.y(), 1e-8);
}

TEST(StiffFlopSeries, WithoutLoadsAndPressuresIsStraight) {
  const ModuleSeries series = Unlike();
  const Solution s = SolveForward(
      series, kFull, Loaded({0, 0, 0, 0, 0, 0, 0}, Vector3d::Zero(), Vector3d::Zero()), false);
  ASSERT_EQ(s.status, Status::kOk);
  const double tip = series.length() + series.first().l_fs;
  EXPECT_LT((s.tip - Vector3d(0, tip, 0)).norm(), 1e-12);
}

// Hooke's law without shrinking: the lower module is longer by what hangs on it, its mount is
// rigid.
TEST(StiffFlopSeries, TheLowerModuleCarriesWhatHangsOnIt) {
  ModuleSeries series = Unlike();
  for (Module& module : series.modules) module.r_c1 = 1e-9;  // no bores
  const double g = 9.81;
  const Solution s =
      SolveForward(series, kPlain, Loaded({0, 0, 0, 0, 0, 0, 0}, Vector3d::Zero()), false);
  ASSERT_EQ(s.status, Status::kOk);
  const Module &a = series[0], &b = series[1];
  const double upper = b.m_fs + b.m / 2, lower = a.m / 2 + a.m_fs + b.m + b.m_fs;
  const double longer = g * (a.l * lower / (a.E * a.Area()) + b.l * upper / (b.E * b.Area()));
  EXPECT_NEAR(s.tip.y(), a.l + a.l_fs + b.l + longer, 1e-6 * longer);
}

TEST(StiffFlopSeries, TurningLoadsAndLinesTurnsTheShape) {
  for (const int count : {2, 3, 4}) {
    Module module = Published();
    module.lines = EvenLines(count);
    const ModuleSeries series({module, module});
    VectorXd p(2 * count);
    for (int i = 0; i < 2 * count; ++i) p[i] = 1e4 * ((3 * i) % 5);
    VectorXd next = p;
    for (int i = 0; i < count; ++i) {
      next[(i + 1) % count] = p[i];
      next[count + (i + 1) % count] = p[count + i];
    }
    const Vector3d force(0.02, 0.01, -0.015);
    const double turn = 2 * pi / count;
    const Solution a = SolveForward(series, kFull, {"", p, {force, {0, 9.81, 0}}}, false);
    const Solution b =
        SolveForward(series, kFull, {"", next, {Turned(force, turn), {0, 9.81, 0}}}, false);
    ASSERT_EQ(a.status, Status::kOk) << count << a.outcome.why;
    ASSERT_EQ(b.status, Status::kOk) << count << b.outcome.why;
    EXPECT_LT((Turned(a.tip, turn) - b.tip).norm(), 1e-9 * series.length()) << count;
  }
}

TEST(StiffFlopSeries, LinesAtGivenAnglesTurnWithThem) {
  Module module = Published(), turned = module;
  const double angle = 0.7;
  for (auto& line : turned.lines) {
    line = {line[0] * std::cos(angle) - line[1] * std::sin(angle),
            line[0] * std::sin(angle) + line[1] * std::cos(angle)};
  }
  const Case row = Loaded({4e4, 1e4, 0}, Vector3d::Zero());
  const Solution a = SolveForward(module, kFull, row, false);
  const Solution b = SolveForward(turned, kFull, row, false);
  ASSERT_EQ(b.status, Status::kOk);
  EXPECT_LT((Turned(a.tip, angle) - b.tip).norm(), 1e-9 * module.l);
  EXPECT_NEAR(std::remainder(b.answer[1] - a.answer[1] - angle, 2 * pi), 0, 1e-9);
}

// The upper module alone, with all loads as they are seen from its base.
TEST(StiffFlopSeries, TheUpperModuleIsThatOfItsOwn) {
  const ModuleSeries series = Unlike();
  const Case row = UnlikeCase();
  const Solution s = SolveForward(series, kFull, row, false);
  ASSERT_EQ(s.status, Status::kOk) << s.outcome.why;
  const auto places = Places(series, kFull, row, s);
  const auto& joint = places[33];  // after the mount, 32 pieces a module
  const Eigen::Quaterniond back = joint.frame.conjugate();
  const Case own{
      "", series.PressuresOf(1, row.given), {back * row.load.force, back * row.load.gravity}};
  const Solution upper = SolveForward(series[1], kFull, own, false);
  ASSERT_EQ(upper.status, Status::kOk);
  EXPECT_LT((joint.point + joint.frame * upper.tip - s.tip).norm(), 1e-8 * series.length());
}

// The section of fixed+fixed has a potential: its slope by the force is minus the way of where that
// acts.
TEST(StiffFlopSeries, TheEnergysSlopeIsTheWayOfTheForce) {
  const ModuleSeries series = Unlike();
  const Case row = UnlikeCase();
  const Solution s = SolveForward(series, kPlain, row, false);
  ASSERT_EQ(s.status, Status::kOk);
  const auto energy = [&](const Vector3d& more) {
    Case at = row;
    at.load.force += more;
    const Solution solved = SolveForward(series, kPlain, at, false);
    return Describe(series, kPlain, Direction::kForward, at, solved).energy;
  };
  const double straight = series.length() + series.mounts();
  const Vector3d way = s.tip + series.last().l_fs * s.tangent - Vector3d(0, straight, 0);
  for (int i = 0; i < 3; ++i) {
    const Vector3d step = 1e-3 * Vector3d::Unit(i);
    const double slope = (energy(step) - energy(-step)) / 2e-3;
    EXPECT_NEAR(slope, -way[i], 2e-3 * series.length());  // 32 pieces stand for a module
  }
}

TEST(StiffFlopSeries, TheBaseCarriesAllDeadLoads) {
  const ModuleSeries series = Unlike();
  const Case row = UnlikeCase();
  const Solution s = SolveForward(series, kFull, row, false);
  ASSERT_EQ(s.status, Status::kOk);
  const auto details = Describe(series, kFull, Direction::kForward, row, s);
  EXPECT_LT((details.force - row.load.force - series.mass() * row.load.gravity).norm(), 1e-12);
  Vector3d moment = (s.tip + series.last().l_fs * s.tangent).cross(row.load.force);
  const auto places = Places(series, kFull, row, s);
  for (std::size_t j = 0; j < 2; ++j) {
    const auto& end = places[33 * j + 32];
    const Vector3d t = end.frame * Vector3d::UnitY();
    const Module& m = series[j];
    moment += (end.point + 0.5 * m.l_fs * t).cross(m.m_fs * row.load.gravity);
    for (std::size_t i = 33 * j; i < 33 * j + 32; ++i) {
      const Vector3d middle = 0.5 * (places[i].point + places[i + 1].point);
      moment += middle.cross(m.m / 32 * row.load.gravity);
    }
  }
  EXPECT_LT((details.moment - moment).norm(), 1e-3 * moment.norm());
}

TEST(StiffFlopSeries, TheResponseIsThatOfDifferencesOfSolves) {
  const ModuleSeries series = Unlike();
  const Case row = UnlikeCase();
  const Solution s = SolveForward(series, kFull, row, false);
  const auto response = Respond(series, kFull, row, s);
  ASSERT_TRUE(response);
  ASSERT_EQ(response->slope.cols(), 10);
  for (const int i : {0, 3, 7}) {
    const double step = i < 3 ? 1e-3 : 100;
    Case up = row, down = row;
    (i < 3 ? up.load.force[i] : up.given[i - 3]) += step;
    (i < 3 ? down.load.force[i] : down.given[i - 3]) -= step;
    const Vector3d moved = (SolveForward(series, kFull, up, false).tip -
                            SolveForward(series, kFull, down, false).tip) /
                           (2 * step);
    EXPECT_LT((response->slope.col(i).head<3>() - moved).norm(), 1e-4 * moved.norm()) << i;
  }
}

TEST(StiffFlopSeries, ReachesAPlaceOfBothEnds) {
  const ModuleSeries series = Unlike();
  Case row = UnlikeCase();
  const Solution s = SolveForward(series, kFull, row, false);
  const Eigen::Matrix3Xd ends = EndsOf(series, kFull, row, s);
  row.given.setZero();
  const VectorXd both = VectorXd::Map(ends.data(), 6);
  const auto reached = Reach(series, kFull, row, {"", {0, 1, 2, 3, 4, 5}, both});
  ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
  EXPECT_LT(reached.miss, 1e-6 * series.length());
  EXPECT_LE(reached.drives.norm(), 1.001 * UnlikeCase().given.norm());  // the least ones
}

// Four lines balance a shape by more than one set of pressures: the least is found, and gives the
// shape back.
TEST(StiffFlopLines, FourLinesHoldAShapeByTheLeastPressures) {
  Module module = Published();
  module.lines = EvenLines(4);
  const Case shape{"", Vector3d(12, 0.4, 1.1), {Vector3d::Zero(), Vector3d::Zero()}};
  const Method method = Method::Parse("hooke+fixed+fixed", Direction::kInverse);
  const Solution s = SolveInverse(module, method, shape, false);
  ASSERT_EQ(s.status, Status::kOk) << s.outcome.why;
  ASSERT_EQ(s.answer.size(), 4);
  // p + c (1, -1, 1, -1) bends and lengthens alike: the least p has no part along it.
  EXPECT_NEAR(s.answer[0] - s.answer[1] + s.answer[2] - s.answer[3], 0,
              0.05 * s.answer.cwiseAbs().maxCoeff());
}

TEST(StiffFlopLines, TwoLinesBalanceShapesInTheirPlaneOnly) {
  Module module = Published();
  module.lines = EvenLines(2);
  const Method method = Method::Parse("hooke+fixed+fixed", Direction::kInverse);
  const Case aside{"", Vector3d(12, pi / 2, 1.1), {Vector3d::Zero(), Vector3d::Zero()}};
  EXPECT_NE(SolveInverse(module, method, aside, false).status, Status::kOk);
  const Case plane{"", Vector3d(12, 0, 1.1), {Vector3d::Zero(), Vector3d::Zero()}};
  EXPECT_EQ(SolveInverse(module, method, plane, false).status, Status::kOk);
}

TEST(StiffFlopSeries, SensitivitiesAreDifferencesOfTipsWithAllModulesChangedAtOnce) {
  const Case row = UnlikeCase();
  const Solution s = SolveForward(Unlike(), kFull, row, true);
  const auto tip = [&](double dE, double dgamma) {
    ModuleSeries changed = Unlike();
    for (Module& module : changed.modules) {
      module.E += dE;
      module.gamma += dgamma;
    }
    return SolveForward(changed, kFull, row, false).tip;
  };
  const double E = 100, gamma = 1e-4;  // 1e-3 and 1e-4 of the values: differences err by 1e-6
  EXPECT_LT((s.by_E - (tip(E, 0) - tip(-E, 0)) / (2 * E)).norm(), 1e-4 * s.by_E.norm());
  EXPECT_LT((s.by_gamma - (tip(0, gamma) - tip(0, -gamma)) / (2 * gamma)).norm(),
            1e-4 * s.by_gamma.norm());
}

}  // namespace
}  // namespace continuum::stiff_flop
