#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"
#include "models/stiff_flop/published.h"

namespace continuum::stiff_flop {

static void PrintTo(const Method& method, std::ostream* out) {
  std::string name = method.Name(Direction::kInverse);
  std::replace(name.begin(), name.end(), '+', '_');
  *out << name;
}

namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kThird = 2 * pi / 3;

// A braid that matters, two tubes per line. (At 80 deg the gas volume of the exact helix is nearly
// stationary and pressures are huge.)
Module Loose() {
  Module module = Published();
  module.gamma = 84 * pi / 180;
  module.n_c = 2;
  return module;
}

Case Free(const Vector3d& given) { return {"", given, {Vector3d::Zero(), Vector3d::Zero()}}; }
Case Hanging(const Vector3d& given, const Vector3d& force = Vector3d::Zero()) {
  return {"", given, {force, {0, 9.81, 0}}};
}

Vector3d Turned(const Vector3d& v, double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitY()) * v;
}

double Energy(const Module& module, const Method& method, const Axis<double>& axis) {
  return module.E * module.l * ActionsOf(module, method, module.gamma, axis).elastic;
}

class StiffFlop : public testing::TestWithParam<Method> {
 protected:
  static Solution Inverse(const Module& module, const Case& row, bool sensitivity = false) {
    return SolveInverse(module, GetParam(), row, sensitivity);
  }
  static Solution Forward(const Module& module, const Case& row, bool sensitivity = false) {
    return SolveForward(module, GetParam(), row, sensitivity);
  }
};
INSTANTIATE_TEST_SUITE_P(Table2, StiffFlop, testing::ValuesIn(Method::All()),
                         testing::PrintToStringParamName());

TEST_P(StiffFlop, InverseNeedsNoPressureUnloadedAndStraight) {
  const Solution solution = Inverse(Loose(), Free({0, 0, 1}));
  ASSERT_EQ(solution.status, Status::kOk);
  EXPECT_LT(solution.answer.norm(), 1e-8);  // of E = 1e5 Pa: rounding
  EXPECT_NEAR(solution.tip.y(), 44e-3, 1e-17);
}

// Pressures minimise: U + loads - p v is stationary in q, by differences of the actions.
TEST_P(StiffFlop, InverseDoesNoVirtualWork) {
  const Module module = Loose();
  const Case row = Hanging({22, 0.7, 1.15}, {0.2, -0.1, 0.3});
  const Solution solution = Inverse(module, row);
  ASSERT_EQ(solution.status, Status::kOk);
  const Vector3d q(22 * std::cos(0.7), 22 * std::sin(0.7), 1.15);
  const auto total = [&](const Vector3d& at) {
    const Axis<double> axis{at[2], at[0], at[1]};
    const Actions<double> actions = ActionsOf(module, GetParam(), module.gamma, axis);
    double sum = module.E * module.l * actions.elastic + LoadPotential(module, row.load, axis);
    for (int i = 0; i < 3; ++i) sum -= solution.answer[i] * actions.volume[i];
    return sum;
  };
  const double unit = module.E * module.Area() * module.l;
  for (int k = 0; k < 3; ++k) {
    const double h = k < 2 ? 1e-2 : 1e-5;
    const Vector3d step = h * Vector3d::Unit(k);
    const double slope = (total(q + step) - total(q - step)) / (2 * h);
    // Differences of second order of an energy known to 1e-16.
    EXPECT_NEAR(slope / (unit * (k < 2 ? module.r_2 : 1)), 0, 1e-8);
  }
}

TEST_P(StiffFlop, InverseIsSmoothAtZeroCurvature) {
  const Module module = Loose();
  const Vector3d straight = Inverse(module, Hanging({0, 0.4, 1.2})).answer;
  const Vector3d nearly = Inverse(module, Hanging({1e-9, 0.4, 1.2})).answer;
  EXPECT_LT((nearly - straight).norm(), 1e-6 * straight.norm());
  const Vector3d bent = Inverse(module, Hanging({1e-3, 0.4, 1.2})).answer - straight;
  const Vector3d twice = Inverse(module, Hanging({2e-3, 0.4, 1.2})).answer - straight;
  EXPECT_LT((twice - 2 * bent).norm(), 1e-3 * bent.norm() + 1e-6);
  const Vector3d other = Inverse(module, Hanging({0, 2.9, 1.2})).answer;
  EXPECT_LT((other - straight).norm(), 1e-9 * straight.norm());
}

TEST_P(StiffFlop, TurningShapeAndLoadsByALinePermutesPressures) {
  const Module module = Loose();
  const Case row = Hanging({18, 0.3, 1.1}, {0.1, 0, 0.2});
  Case turned = row;
  turned.given[1] += kThird;
  turned.load.force = Turned(row.load.force, kThird);
  const Vector3d p = Inverse(module, row).answer;
  const Vector3d q = Inverse(module, turned).answer;
  EXPECT_LT((q - Vector3d(p[2], p[0], p[1])).norm(), 1e-10 * p.norm());
}

TEST_P(StiffFlop, PressureIsProportionalToTheModulusWithoutLoads) {
  const Solution solution = Inverse(Loose(), Free({18, 0.3, 1.1}), true);
  EXPECT_LT((solution.by_E - solution.answer / 1e5).norm(), 1e-13 * solution.by_E.norm());
}

TEST_P(StiffFlop, InverseSensitivitiesAreThoseOfPerturbedModules) {
  const Module module = Loose();
  const Case row = Hanging({18, 0.3, 1.1}, {0.1, 0, 0.2});
  const Solution solution = Inverse(module, row, true);
  const auto at = [&](double gamma, double E) {
    Module changed = module;
    changed.gamma += gamma;
    changed.E += E;
    return Inverse(changed, row).answer;
  };
  const Vector3d by_gamma = (at(1e-5, 0) - at(-1e-5, 0)) / 2e-5;
  const Vector3d by_E = (at(0, 10) - at(0, -10)) / 20;
  EXPECT_LT((solution.by_gamma - by_gamma).norm(), 1e-6 * by_gamma.norm() + 1e-9);
  EXPECT_LT((solution.by_E - by_E).norm(), 1e-8 * by_E.norm());
}

TEST_P(StiffFlop, AnglesOfRingsHaveNoFirstOrderEffect) {
  Module module = Published();
  module.gamma = pi / 2;
  EXPECT_LT(Inverse(module, Hanging({18, 0.3, 1.1}), true).by_gamma.norm(), 1e-4);  // of 1e5 Pa
  EXPECT_LT(Forward(module, Hanging({4e4, 0, 1e4}), true).by_gamma.norm(), 1e-12);
}

TEST_P(StiffFlop, ForwardUnloadedStaysStraight) {
  const Solution solution = Forward(Loose(), Free({0, 0, 0}), true);
  ASSERT_EQ(solution.status, Status::kOk);
  EXPECT_LT((solution.tip - Vector3d(0, 44e-3, 0)).norm(), 1e-16);
  EXPECT_EQ(solution.answer[0], 0);
  EXPECT_EQ(solution.answer[2], 1);
}

TEST_P(StiffFlop, ForwardWithoutLoadsIsAnArc) {
  const Module module = Loose();
  const Solution solution = Forward(module, Free({6e4, 2e4, 0}));
  ASSERT_EQ(solution.status, Status::kOk);
  const Vector3d& shape = solution.answer;
  const Arc<double> arc(module.l,
                        {shape[2], shape[0] * std::cos(shape[1]), shape[0] * std::sin(shape[1])});
  EXPECT_GT(shape[0], 3);
  EXPECT_LT((solution.tip - Vector3d::Map(arc.tip.data())).norm(), 1e-9 * module.l);
  EXPECT_LT((solution.tangent - Vector3d::Map(arc.tangent.data())).norm(), 1e-9);
}

TEST_P(StiffFlop, PressureBendsAwayFromItsLine) {
  const Solution solution = Forward(Loose(), Free({4e4, 0, 0}));
  ASSERT_EQ(solution.status, Status::kOk);
  EXPECT_LT(solution.tip.x(), -1e-3);
  EXPECT_NEAR(std::abs(solution.answer[1]), pi, 1e-12);
  EXPECT_GT(solution.answer[2], 1);
}

TEST_P(StiffFlop, TurningLoadsAndPressuresByALineTurnsTheShape) {
  const Module module = Loose();
  const Case row = Hanging({5e4, 1e4, 2e4}, {0.05, 0.02, -0.03});
  Case turned = row;
  turned.given = Vector3d(row.given[2], row.given[0], row.given[1]);
  turned.load.force = Turned(row.load.force, kThird);
  const Solution a = Forward(module, row);
  const Solution b = Forward(module, turned);
  ASSERT_EQ(a.status, Status::kOk);
  EXPECT_LT((Turned(a.tip, kThird) - b.tip).norm(), 1e-9 * module.l);
  EXPECT_LE(a.outcome.residual, 1e-9);
}

TEST_P(StiffFlop, ForwardSensitivitiesAreThoseOfPerturbedModules) {
  const Module module = Loose();
  const Case row = Hanging({5e4, 1e4, 2e4}, {0.05, 0.02, -0.03});
  const Solution solution = Forward(module, row, true);
  const auto at = [&](double gamma, double E) {
    Module changed = module;
    changed.gamma += gamma;
    changed.E += E;
    return Forward(changed, row).tip;
  };
  const Vector3d by_gamma = (at(1e-4, 0) - at(-1e-4, 0)) / 2e-4;
  const Vector3d by_E = (at(0, 50) - at(0, -50)) / 100;
  EXPECT_LT((solution.by_gamma - by_gamma).norm(), 1e-5 * by_gamma.norm() + 1e-14);
  EXPECT_LT((solution.by_E - by_E).norm(), 1e-5 * by_E.norm());
}

// The moment at the base that the tip needs, against the loads of the line it was solved for.
TEST_P(StiffFlop, ForwardBalancesTheLoadsOfItsOwnShape) {
  const Module module = Loose();
  const Case row = Hanging({5e4, 1e4, 2e4}, {0.05, 0.02, -0.03});
  const Solution solution = Forward(module, row);
  ASSERT_EQ(solution.status, Status::kOk);
  const std::vector<Vector3d> line = ForwardLine(module, GetParam(), row);
  ASSERT_EQ(line.size() % 2, 1u);
  EXPECT_LT((line.back() - solution.tip).norm(), 1e-9 * module.l);
  // Simpson's rule over s, which the points divide evenly.
  Vector3d moment = Vector3d::Zero();
  const double pieces = static_cast<double>(line.size() - 1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double weight = (i == 0 || i + 1 == line.size() ? 1 : i % 2 == 1 ? 4 : 2) / (3 * pieces);
    moment += weight * module.m * line[i].cross(row.load.gravity);
  }
  const Vector3d weight = module.m_fs * row.load.gravity;
  const Vector3d end = module.l_fs * solution.tangent;
  moment += (solution.tip + 0.5 * end).cross(weight) + (solution.tip + end).cross(row.load.force);
  EXPECT_LT((moment - BaseMoment(module, GetParam(), row)).norm(), 1e-7 * moment.norm());
}

// A section that shrinks has a highest pressure. A fixed one has none, and that of the exact helix
// closes its bores before it comes to one.
TEST_P(StiffFlop, NoShrinkingSectionCarriesAnyPressure) {
  const Solution solution = Forward(Published(), Free({5e6, 5e6, 5e6}));
  const Status expected = GetParam().body == BodyLaw::kFixed         ? Status::kOk
                          : GetParam().chamber == ChamberLaw::kExact ? Status::kOutOfDomain
                                                                     : Status::kNoEquilibrium;
  EXPECT_EQ(solution.status, expected) << solution.outcome.why;
}

TEST_P(StiffFlop, RandomLoadsAndPressuresSettle) {
  std::mt19937 source(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double scale) {
    return Vector3d(scale * unit(source), scale * unit(source), scale * unit(source));
  };
  for (int i = 0; i < 10; ++i) {
    const Case row{"", Vector3d::Constant(4e4) + vector(4e4), {vector(0.3), vector(9.81)}};
    const Solution solution = Forward(Published(), row);
    EXPECT_EQ(solution.status, Status::kOk) << solution.outcome.why;
    EXPECT_LE(solution.outcome.residual, 1e-9);
  }
}

TEST_P(StiffFlop, ShapesThatFoldAreOutOfTheDomain) {
  EXPECT_EQ(Inverse(Published(), Free({81, 0, 1})).status, Status::kOutOfDomain);  // kappa r_2 > 1
  if (GetParam().chamber != ChamberLaw::kFixed) {
    EXPECT_EQ(Inverse(Loose(), Free({0, 0, 9.6})).status, Status::kOutOfDomain);
  }
}

TEST(StiffFlopForward, TimoshenkoCantileverUnderASmallTipForce) {
  const Module module = Published();
  const Method method{BodyLaw::kFixed, ChamberLaw::kFixed};
  Case row = Free({0, 0, 0});
  const double force = 1e-6;
  row.load.force = {force, 0, 0};
  const Solution solution = SolveForward(module, method, row, false);
  const double gas = pi * 2.5e-3 * 2.5e-3;
  const double area = module.Area() - 3 * gas;
  const double J = module.SecondMoment() - 3 * gas * gas / (4 * pi) - 1.5 * gas * 9e-3 * 9e-3;
  const double l = module.l, end = module.l_fs;
  const double bending = force * l * l * (l / 3 + end / 2) / (module.E * J);
  const double shear = force * l / (module.E / 3 * area);
  EXPECT_NEAR(solution.tip.x(), bending + shear, 1e-7 * bending);
  EXPECT_NEAR(solution.tangent.x(), force * l * (l / 2 + end) / (module.E * J), 1e-12);
}

TEST(StiffFlopForward, FixedBodyUnderTensionIsHookesRod) {
  const Module module = Published();
  const Method method{BodyLaw::kFixed, ChamberLaw::kFixed};
  const Solution solution =
      SolveForward(module, method, Hanging({3e4, 3e4, 3e4}, {0, 2, 0}), false);
  const double gas = pi * 2.5e-3 * 2.5e-3;
  const double force = 2 + 3 * 3e4 * gas + (module.m_fs + module.m / 2) * 9.81;
  const double strain = force / (module.E * (module.Area() - 3 * gas));
  EXPECT_NEAR(solution.tip.y(), module.l * (1 + strain), 1e-13);
}

// (lambda - 1)(a - 3 gas lambda)/lambda E = 3 p gas has its maximum at lambda = sqrt(a/(3 gas)).
TEST(StiffFlopForward, EquilibriumEndsAtTheLimitPressureOfTheShrinkingSection) {
  Module module = Published();
  const Method method{BodyLaw::kElongation, ChamberLaw::kFixed};
  const double gas = 3 * pi * 2.5e-3 * 2.5e-3;
  const double lambda = std::sqrt(module.Area() / gas);
  const double limit = module.E * (lambda - 1) * (module.Area() / lambda - gas) / gas;
  const auto at = [&](double share) {
    return SolveForward(module, method, Free(Vector3d::Constant(share * limit)), false);
  };
  const Solution below = at(0.9999);
  ASSERT_EQ(below.status, Status::kOk);
  EXPECT_LT(below.answer[2], lambda);
  EXPECT_GT(below.answer[2], 0.97 * lambda);
  EXPECT_EQ(at(1.0001).status, Status::kNoEquilibrium);
}

TEST(StiffFlopForward, LongModuleUnderItsOwnWeightSettlesInStrongBending) {
  Module module = Published();
  module.l = 0.4;
  for (const double side : {9.81, -9.81}) {
    Case row{"", Vector3d(2e4, 0, 0), {Vector3d::Zero(), {side, 0, 0}}};
    const Solution solution = SolveForward(module, {}, row, false);
    ASSERT_EQ(solution.status, Status::kOk) << solution.outcome.why;
    EXPECT_LE(solution.outcome.residual, 1e-9);
  }
}

TEST(StiffFlopInverse, CentreOfMassIsTheMeanOfTheArc) {
  const Axis<double> axis{1.2, 20 * std::cos(0.4), 20 * std::sin(0.4)};
  Vector3d mean = Vector3d::Zero();
  constexpr int kPoints = 1000;
  for (int i = 0; i < kPoints; ++i) {
    mean += Vector3d::Map(Arc<double>(0.044 * (i + 0.5) / kPoints, axis).tip.data()) / kPoints;
  }
  EXPECT_LT((mean - Vector3d::Map(Arc<double>(0.044, axis).centre.data())).norm(), 1e-8);
}

TEST(StiffFlopInverse, ArcTurnsYTowardTheDirectionOfBending) {
  const double phi = 0.9, theta = 30 * 1.1 * 0.044;
  const Arc<double> arc(0.044, {1.1, 30 * std::cos(phi), 30 * std::sin(phi)});
  const Vector3d n(std::cos(phi), 0, -std::sin(phi));
  const Vector3d expected = std::sin(theta) * n + std::cos(theta) * Vector3d::UnitY();
  EXPECT_LT((Vector3d::Map(arc.tangent.data()) - expected).norm(), 1e-14);
  EXPECT_GT(Vector3d::Map(arc.tip.data()).dot(n), 0);
}

TEST(StiffFlopInverse, HookesEnergyOverNeoHookeanInElongation) {
  const double lambda = 1.4;
  Module module = Published();
  const Axis<double> axis{lambda, 0, 0};
  module.r_c1 = 1e-6, module.r_c2 = 2e-6;  // hardly any tubes
  const double hooke = Energy(module, {BodyLaw::kFixed, ChamberLaw::kFixed}, axis);
  const double neo = Energy(module, {BodyLaw::kElongation, ChamberLaw::kFixed}, axis);
  EXPECT_NEAR(hooke / neo, 3 * lambda * lambda / (lambda + 2), 1e-6);
}

}  // namespace
}  // namespace continuum::stiff_flop
