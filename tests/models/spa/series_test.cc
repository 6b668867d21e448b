#include "models/spa/series.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/spa/chain.h"
#include "models/spa/statics.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

using Eigen::Vector3d, Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SpaFile File() {
  SpaFile file = ReadSpa(std::string(CONTINUUM_SOURCE) + "/models/spa/spa.yaml");
  file.options.mass = SpaMass::kArc;  // as the chain
  return file;
}

SpaSeries Series(int segments, const SpaFile& file = File()) {
  return {Spa<double>(file.parameters, file.options), segments};
}

SpaBase<double> Placed(bool standing) {
  return standing ? SpaBase<double>{} : SpaBase<double>::Hanging();
}

VectorXd Random(Eigen::Index n, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-size, size);
  return VectorXd::NullaryExpr(n, [&] { return u(random); });
}

TEST(SpaSeries, OneIsTheActuatorToTheLastBit) {
  std::mt19937 random{3};
  const SpaSeries series = Series(1);
  for (int k = 0; k < 20; ++k) {
    const Vector6 q = Random(6, 1, random), rate = Random(6, 2, random);
    const auto base = SpaCardan<double>::Base(q, rate, Random(6, 9, random));
    const SpaState<double> state{Random(3, 0.06, random), Random(3, 1, random)};
    const Vector3d acceleration = Random(3, 50, random);
    Vector6 wrench;
    const VectorXd forces =
        series.InverseDynamics(state.delta, state.rate, acceleration, base, &wrench);
    const auto due = series.segment().InverseDynamics(state, acceleration, base);
    EXPECT_EQ(wrench, due.head<6>());
    EXPECT_EQ(forces, due.tail<3>());
  }
}

// d/dt ∂T/∂q̇ − ∂(T − V)/∂q from the energies alone, by differences.
TEST(SpaSeries, ItsForcesAreLagrangesEquations) {
  std::mt19937 random{5};
  SpaFile file = File();
  file.parameters.d_theta = file.parameters.d_dL = 0;
  const SpaSeries series = Series(3, file);
  const SpaBase<double> base = Placed(false);
  const VectorXd q = Random(9, 0.03, random), v = Random(9, 0.5, random), a = Random(9, 20, random);
  constexpr double kStep = 1e-5;
  const auto lagrangian = [&](const VectorXd& at, const VectorXd& rate) {
    const auto e = series.Energy(at, rate, base);
    return e.kinetic - e.gravity - e.elastic;
  };
  const auto slope = [&](auto&& f, Eigen::Index i) {
    const VectorXd by = kStep * VectorXd::Unit(9, i);
    return (f(by) - f(VectorXd(-by))) / (2 * kStep);
  };
  const auto momentum = [&](Eigen::Index i, double t) {
    const VectorXd at = q + t * v + t * t / 2 * a, rate = v + t * a;
    return slope([&](const VectorXd& by) { return lagrangian(at, rate + by); }, i);
  };
  const VectorXd forces = series.InverseDynamics(q, v, a, base);
  constexpr double kTime = 1e-3;
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double change = (momentum(i, -2 * kTime) - 8 * momentum(i, -kTime) +
                           8 * momentum(i, kTime) - momentum(i, 2 * kTime)) /
                          (12 * kTime);
    const double due = change - slope([&](const VectorXd& by) { return lagrangian(q + by, v); }, i);
    // Rounding of an energy of 1 J over two steps of 1e-5 and a time of 1 ms.
    EXPECT_NEAR(forces[i], due, 1e-4 * forces.norm()) << i;
  }
}

TEST(SpaSeries, WithoutDampingItKeepsItsEnergy) {
  SpaFile file = File();
  file.parameters.d_theta = file.parameters.d_dL = 0;
  const SpaSeries series = Series(2, file);
  const SpaBase<double> base = Placed(false);
  const std::vector<VectorXd> none(151, VectorXd::Zero(6));
  const auto samples = SpaSeriesRespond(series, none, 1e-3, [&](double) { return base; });
  const auto total = [&](const SpaSeriesSample& s) {
    const auto e = series.Energy(s.delta, s.rate, base);
    return e.kinetic + e.gravity + e.elastic;
  };
  double kinetic = 0;
  for (const auto& s : samples) {
    kinetic = std::max(kinetic, series.Energy(s.delta, s.rate, base).kinetic);
    EXPECT_NEAR(total(s), total(samples.front()), 1e-9);
  }
  EXPECT_GT(kinetic, 1e-3);
}

TEST(SpaSeries, AtRestOneIsTheActuatorsEquilibrium) {
  for (const bool standing : {false, true}) {
    const SpaSeries series = Series(1);
    const Vector3d pressure(50e3, 10e3, 0);
    const VectorXd delta = SpaSeriesEquilibrium(series, pressure, Placed(standing));
    const Vector3d due = SpaEquilibrium(series.segment(), pressure, Placed(standing));
    EXPECT_LT((delta - due).norm(), 1e-12);
  }
}

// Straight and hanging, the upper of two carries the weight of both: (2/3) k_dL1 x_f =
// 3 A p + m g/2 + m g.
TEST(SpaSeries, FoldsWhereTheUpperSpringDoes) {
  SpaFile file = File();
  file.parameters.x_m = file.parameters.y_m = 0;  // it stays straight
  const SpaSeries series = Series(2, file);
  const auto& p = file.parameters;
  const double fold = std::sqrt(-p.k_dL1 / (3 * p.k_dL3));
  const double due = (2.0 / 3 * p.k_dL1 * fold - 1.5 * p.m * 9.81) / (3 * p.A);
  EXPECT_NO_THROW(SpaSeriesEquilibrium(series, VectorXd::Constant(6, due * 0.999), Placed(false)));
  EXPECT_THAT(
      [&] { SpaSeriesEquilibrium(series, VectorXd::Constant(6, due * 1.001), Placed(false)); },
      ThrowsMessage<Error>(HasSubstr("no stable equilibrium")));
}

// The generated arm in MuJoCo beside it, in parts of the range, from a step of the pressures.
void ExpectTheChain(int segments, bool standing, const VectorXd& pressure) {
  const SpaFile file = File();
  ModelAndData machine =
      ModelSpec::Parse(SpaMjcf(file, {.series = segments, .standing = standing})).Build();
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  m.opt.timestep = 2e-4;
  m.opt.integrator = mjINT_RK4;  // which integrates the lag itself
  std::replace(m.actuator_dyntype, m.actuator_dyntype + m.nu, int{mjDYN_FILTEREXACT},
               int{mjDYN_FILTER});
  const std::vector<VectorXd> input(401, pressure);
  const auto truth = SpaSeriesRespond(Series(segments, file), input, 1e-3,
                                      [&](double) { return Placed(standing); });
  const auto sensor = [&](const std::string& name) {
    return Vector3d(Eigen::Map<const Vector3d>(
        d.sensordata + m.sensor_adr[mj_name2id(&m, mjOBJ_SENSOR, name.c_str())]));
  };
  const std::string last = "seg" + std::to_string(segments) + "_";
  double off = 0, range = 0, force_off = 0, force = 0;
  for (const auto& sample : truth) {
    while (d.time < sample.time - 1e-9) mj_step(&m, &d);
    Eigen::Map<VectorXd>(d.ctrl, m.nu) = pressure;
    mj_forward(&m, &d);
    const Vector3d tip = Placed(standing).R_WB.transpose() * sensor(last + "tip_pos");
    off = std::max(off, (tip - sample.tip).norm());
    range = std::max(range, (sample.tip - truth.front().tip).norm());
    const Vector3d base = sensor("seg1_base_force");
    force_off = std::max(force_off, (base - sample.wrench.head<3>()).norm());
    force = std::max(force, (sample.wrench - truth.front().wrench).head<3>().norm());
  }
  EXPECT_GT(range, 0.01);
  // One actuator of ten links is off by 0.1 to 0.2 % (README), two carry the error on.
  EXPECT_LT(off, 0.005 * range) << segments << standing;
  EXPECT_LT(force_off, 0.01 * force) << segments << standing;
}

TEST(SpaSeries, IsTheGeneratedArmHangingAndStanding) {
  VectorXd pressure(6);
  pressure << 20e3, 0, 5e3, 0, 15e3, 10e3;
  ExpectTheChain(2, false, pressure);
  ExpectTheChain(2, true, 0.5 * pressure);
}

TEST(SpaLayout, StandingItRestsWhereTheActuatorDoes) {
  const SpaFile file = File();
  const ModelAndData machine = ModelSpec::Parse(SpaMjcf(file, {.standing = true})).Build();
  mjData& d = *machine.data;
  d.ctrl[0] = 30e3;
  while (d.time < 5) mj_step(machine.model.get(), &d);
  mj_forward(machine.model.get(), &d);
  const Spa<double> spa(file.parameters, file.options);
  const Vector3d due = SpaEquilibrium(spa, Vector3d(30e3, 0, 0), SpaBase<double>{});
  const int sensor = mj_name2id(machine.model.get(), mjOBJ_SENSOR, "delta");
  const Vector3d delta(d.sensordata + machine.model->sensor_adr[sensor]);
  EXPECT_LT((delta - due).norm(), 0.002 * due.norm());
}

TEST(SpaLayout, RowsStandBesideEachOther) {
  const ModelSpec spec = ModelSpec::Parse(SpaMjcf(File(), {.links = 4, .series = 2, .row = 3}));
  const mjModel& m = spec.model();
  EXPECT_EQ(m.nu, 18);
  EXPECT_GE(mj_name2id(&m, mjOBJ_ACTUATOR, "seg6_p3"), 0);
  const int second = mj_name2id(&m, mjOBJ_BODY, "base2");
  ASSERT_GE(second, 0);
  EXPECT_NEAR(m.body_pos[3 * second], 0.16, 1e-12);
}

TEST(SpaSeries, RefusesNone) {
  EXPECT_THAT([] { Series(0); },
              ThrowsMessage<Error>(AllOf(HasSubstr("at least one"), HasSubstr("0"))));
}

}  // namespace
}  // namespace continuum
