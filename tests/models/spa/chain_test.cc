#include "models/spa/chain.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/spa/chain_error.h"
#include "models/spa/statics.h"
#include "sim/io/file.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

using Eigen::Vector3d;

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/spa/";

SpaFile File() { return ReadSpa(kFolder + "spa.yaml"); }
ModelSpec Robot() { return ModelSpec::Load(kFolder + "spa.xml"); }

Vector3d Sensor(const ModelAndData& machine, const std::string& name) {
  const int id = mj_name2id(machine.model.get(), mjOBJ_SENSOR, name.c_str());
  EXPECT_GE(id, 0) << name;
  return Eigen::Map<const Vector3d>(machine.data->sensordata + machine.model->sensor_adr[id]);
}

void RunUntil(const ModelAndData& machine, double time) {
  while (machine.data->time < time - 1e-9) mj_step(machine.model.get(), machine.data.get());
  mj_forward(machine.model.get(), machine.data.get());
}

void Press(const ModelAndData& machine, double p1, double p2, double p3) {
  const double pressure[] = {p1, p2, p3};
  std::copy(pressure, pressure + 3, machine.data->ctrl);
}

TEST(SpaChain, TheCommittedFilesAreTheGeneratedOnes) {
  EXPECT_EQ(ReadFile(kFolder + "spa.xml"), SpaMjcf(File()));
  EXPECT_EQ(ReadFile(kFolder + "spa_series.xml"), SpaMjcf(File(), {.series = 2}));
}

TEST(SpaChain, HasTheNamesThatOthersUse) {
  const ModelSpec robot = Robot();
  const mjModel& m = robot.model();
  for (const char* name : {"p1", "p2", "p3"}) {
    EXPECT_GE(mj_name2id(&m, mjOBJ_ACTUATOR, name), 0) << name;
  }
  for (const char* name : {"delta", "tip_pos", "base_force", "base_torque"}) {
    const int sensor = mj_name2id(&m, mjOBJ_SENSOR, name);
    ASSERT_GE(sensor, 0) << name;
    EXPECT_EQ(m.sensor_dim[sensor], 3) << name;
  }
  EXPECT_EQ(m.nu, 3);
  EXPECT_EQ(m.opt.timestep, 0.002);
}

TEST(SpaChain, ItsMassIsThePublishedOneWithTheInertiaOfALine) {
  const ModelSpec robot = Robot();
  const mjModel& m = robot.model();
  EXPECT_NEAR(m.body_subtreemass[0], 0.1806, 1e-12);
  const ModelAndData machine = robot.Build();
  mj_forward(&m, machine.data.get());
  double first = 0, second = 0, bending = 0;
  for (int b = 1; b < m.nbody; ++b) {
    const double z = -machine.data->xipos[3 * b + 2] / 0.13;
    first += m.body_mass[b] * z;
    second += m.body_mass[b] * z * z;
    bending += m.body_mass[b] * std::pow(z, 4) / 4;
  }
  EXPECT_NEAR(first, 0.1806 / 2, 1e-12);
  EXPECT_NEAR(second, 0.1806 / 3, 1e-12);
  EXPECT_NEAR(bending, 0.1806 / 20, 1e-4 * 0.1806 / 20);  // Simpson: 0.67/N⁴
}

TEST(SpaChain, BendsTowardXUnderChamberOneAndSaysSo) {
  const ModelAndData machine = Robot().Build();
  Press(machine, 4e4, 0, 0);
  RunUntil(machine, 4);
  EXPECT_GT(Sensor(machine, "delta")[0], 3e-3);
  EXPECT_GT(Sensor(machine, "tip_pos")[0], 3e-3);
}

TEST(SpaChain, RestsInTheAnalyticEquilibrium) {
  SpaFile file = File();
  file.options.mass = SpaMass::kArc;
  const Spa<double> spa(file.parameters, file.options);
  const ModelAndData machine = Robot().Build();
  Press(machine, 4e4, 1e4, 0);
  RunUntil(machine, 8);  // bending dies away as exp(−1.9 t/s)
  const Vector3d delta = SpaEquilibrium(spa, {4e4, 1e4, 0}, SpaBase<double>::Hanging());
  // (θ/2N)²/6 of the shape, and what the soft joint equalities give way.
  EXPECT_LT((Sensor(machine, "delta") - delta).norm(), 2e-4 * delta.norm());
  // At rest the mount carries the weight, upward: −z of the base, which hangs.
  EXPECT_NEAR(Sensor(machine, "base_force")[2], -0.1806 * 9.81, 1e-5);
  EXPECT_NEAR(Sensor(machine, "base_force").head<2>().norm(), 0, 1e-5);
}

// What closed chambers push is inside: raising the pressure moves the wrench by inertia only.
TEST(SpaChain, PressureAloneDoesNotReachTheBase) {
  const ModelAndData machine = Robot().Build();
  Press(machine, 4e4, 4e4, 4e4);
  RunUntil(machine, 6);
  EXPECT_NEAR(Sensor(machine, "base_force")[2], -0.1806 * 9.81, 1e-5);
}

TEST(SpaChain, TheMapOfJointsToDeltaIsTheOneOfTheTip) {
  const ModelAndData machine = Robot().Build();
  Press(machine, 7.5e4, 0, 2e4);
  RunUntil(machine, 8);
  const SpaFile file = File();
  const Spa<double> spa(file.parameters);
  const auto tip = spa.Tip(Sensor(machine, "delta")).position;
  const Vector3d hanging(tip[0], -tip[1], -tip[2]);
  EXPECT_LT((Sensor(machine, "tip_pos") - hanging).norm(), 1e-5);
}

struct Case {
  const char* name;
  Vector3d pressure;
  bool moving;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
class SpaChainStep : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Spa, SpaChainStep,
                         ::testing::Values(Case{"OneChamber", {75e3, 0, 0}, false},
                                           Case{"TwoChambers", {40e3, 40e3, 0}, false},
                                           Case{"ThreeChambers", {40e3, 40e3, 40e3}, false},
                                           Case{"OneChamberMoving", {75e3, 0, 0}, true},
                                           Case{"TwoChambersMoving", {40e3, 40e3, 0}, true},
                                           Case{"ThreeChambersMoving", {40e3, 40e3, 40e3}, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(SpaChainStep, IsTheAnalyticOneInFineSteps) {
  const SpaGap gap =
      ChainError(File(), {GetParam().pressure, GetParam().moving, 10, 2e-4, true, 0.5});
  EXPECT_LT(gap.delta, 0.01);
  EXPECT_LT(gap.tip, 0.01);
  EXPECT_LT(gap.force, 0.02);
  EXPECT_LT(gap.torque, 0.02);
}

TEST(SpaChainOrder, TheErrorShrinksWithTheFourthPowerOfTheLinks) {
  const auto error = [](int links) {
    return ChainError(File(), {Vector3d(75e3, 0, 0), false, links, 2e-4, true, 0.5}).delta;
  };
  const double coarse = error(2), fine = error(4);
  // 16 for small errors; that of two links, a fifth of the range, is not small any more.
  EXPECT_GT(coarse / fine, 8);
}

TEST(SpaChain, IsStableAtItsOwnStepOf2Milliseconds) {
  for (const bool moving : {false, true}) {
    const SpaGap gap = ChainError(File(), {{75e3, 0, 0}, moving, 10, 2e-3, false});
    EXPECT_LT(gap.delta, 0.04);
    EXPECT_LT(gap.tip, 0.04);
  }
}

// F = d(m v)/dt − m g and T = dH/dt − Σ r × m g about the base, by differences of the momentum of
// the links: for the series of two, of which there is no analytic model.
TEST(SpaSeries, ItsBaseWrenchIsTheBalanceOfMomentum) {
  const ModelAndData machine = ModelSpec::Load(kFolder + "spa_series.xml").Build();
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  EXPECT_NEAR(m.body_subtreemass[0], 2 * 0.1806, 1e-12);
  m.opt.integrator = mjINT_RK4;
  m.opt.timestep = 1e-4;
  const double pressure[] = {4e4, 1e4, 0, 0, 2e4, 3e4};
  std::copy(pressure, pressure + 6, d.ctrl);
  RunUntil(machine, 0.1);
  struct Momentum {
    Vector3d linear, angular;
  };
  const auto momentum = [&] {  // in world axes, which are (x, −y, −z) of the base
    mj_forward(&m, &d);
    Momentum sum{Vector3d::Zero(), Vector3d::Zero()};
    for (int b = 1; b < m.nbody; ++b) {
      double v[6];
      mj_objectVelocity(&m, &d, mjOBJ_BODY, b, v, 0);
      const Vector3d p = m.body_mass[b] * Eigen::Map<const Vector3d>(v + 3);
      sum.linear += p;
      sum.angular += Eigen::Map<const Vector3d>(d.xipos + 3 * b).cross(p);
    }
    return sum;
  };
  const Momentum before = momentum();
  mj_step(&m, &d);
  mj_forward(&m, &d);
  const Vector3d flip(1, -1, -1), weight(0, 0, -9.81 * m.body_subtreemass[0]);
  const Vector3d force = Sensor(machine, "seg1_base_force").cwiseProduct(flip);
  const Vector3d torque = Sensor(machine, "seg1_base_torque").cwiseProduct(flip);
  const Vector3d centre = Eigen::Map<const Vector3d>(d.subtree_com);
  mj_step(&m, &d);
  const Momentum after = momentum();
  const Vector3d rate = (after.linear - before.linear) / 2e-4;
  const Vector3d turning = (after.angular - before.angular) / 2e-4;
  // Central differences over 0.1 ms of motions of some 10 Hz, and the armature of the hinges.
  EXPECT_LT((force - (rate - weight)).norm(), 1e-3 * weight.norm());
  EXPECT_LT((torque - (turning - centre.cross(weight))).norm(), 1e-3 * 0.13 * weight.norm());
}

// The pair swings slowly and dies away in some 10 s, because the upper one carries the lower.
TEST(SpaSeries, IsStableAtItsOwnStepAndDiesAway) {
  const ModelAndData machine = ModelSpec::Load(kFolder + "spa_series.xml").Build();
  const double pressure[] = {4e4, 0, 0, 0, 3e4, 3e4};
  std::copy(pressure, pressure + 6, machine.data->ctrl);
  const auto fastest = [&](double until) {
    double most = 0;
    while (machine.data->time < until - 1e-9) {
      mj_step(machine.model.get(), machine.data.get());
      for (int i = 0; i < machine.model->nv; ++i) {
        most = std::max(most, std::abs(machine.data->qvel[i]));
      }
    }
    return most;
  };
  fastest(2);
  const double early = fastest(4);
  fastest(18);
  EXPECT_LT(fastest(20), 0.5 * early);
  mj_forward(machine.model.get(), machine.data.get());
  EXPECT_GT(Sensor(machine, "seg1_delta")[0], 1e-3);
  EXPECT_LT(Sensor(machine, "seg2_delta")[0], -1e-3);
}

TEST(SpaChain, ParametersCanBeFittedInPlace) {
  const ModelSpec robot = Robot();
  const ModelAndData machine = robot.Build(
      std::vector<Change>{{"plugin:segment", "k_dL1", 503.4548}, {"plugin:segment", "k_dL3", 0}});
  RunUntil(machine, 4);
  EXPECT_NEAR(Sensor(machine, "delta")[2], 0.5 * 0.1806 * 9.81 / 503.4548, 1e-6);
}

TEST(SpaChain, RefusesLayoutsThatAreNone) {
  const auto error = [](const SpaLayout& layout) {
    try {
      SpaMjcf(File(), layout);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(error({.links = 5}),
              ::testing::HasSubstr("expected an even number from 2 on, found 5"));
  EXPECT_THAT(error({.links = 0}), ::testing::HasSubstr("found 0"));
  EXPECT_THAT(error({.series = 0}), ::testing::HasSubstr("found 0"));
}

}  // namespace
}  // namespace continuum
