#include "models/stiff_flop/mjcf.h"

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <string>

#include "error.h"
#include "models/stiff_flop/forward.h"
#include "sim/io/file.h"
#include "sim/model/model_spec.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;

const std::string kFolder = CONTINUUM_SOURCE "/models/stiff_flop/";

Robot NoLoad() { return Robot::Read(kFolder + "no_load.yaml"); }

Vector3d Sensor(const ModelAndData& machine, const std::string& name) {
  const int id = mj_name2id(machine.model.get(), mjOBJ_SENSOR, name.c_str());
  EXPECT_GE(id, 0) << name;
  return Eigen::Map<const Vector3d>(machine.data->sensordata + machine.model->sensor_adr[id]);
}

// At rest under pressures [Pa], after 2 s: critical damping, the slower motion at 50 rad/s.
void Settle(const ModelAndData& machine, const Vector3d& pressure) {
  std::copy_n(pressure.data(), 3, machine.data->ctrl);
  while (machine.data->time < 2) mj_step(machine.model.get(), machine.data.get());
  mj_forward(machine.model.get(), machine.data.get());
}

TEST(StiffFlopMjcf, TheCommittedFileIsTheGeneratedOne) {
  EXPECT_EQ(ReadFile(kFolder + "stiff_flop.xml"), ModuleMjcf(NoLoad()));
  EXPECT_EQ(ReadFile(kFolder + "stiff_flop_braid.xml"), ModuleMjcf(NoLoad(), Threads::kBraid));
}

TEST(StiffFlopMjcf, ItsThreadsHaveTheAngleOfTheFile) {
  const double cot = std::tan(std::numbers::pi / 2 - NoLoad().module().gamma);
  const ModelSpec system = ModelSpec::Load(kFolder + "stiff_flop_braid.xml");
  EXPECT_NEAR(system.Value("plugin:threads", "cot2_gamma"), cot * cot, 1e-12);
}

TEST(StiffFlopMjcf, HasTheNamesOfTheSoftActuator) {
  const ModelSpec system = ModelSpec::Load(kFolder + "stiff_flop.xml");
  for (const char* name : {"p1", "p2", "p3"})
    EXPECT_GE(mj_name2id(&system.model(), mjOBJ_ACTUATOR, name), 0) << name;
  for (const char* name : {"delta", "tip_pos", "base_force", "base_torque", "marker_pos"}) {
    const int sensor = mj_name2id(&system.model(), mjOBJ_SENSOR, name);
    ASSERT_GE(sensor, 0) << name;
    EXPECT_EQ(system.model().sensor_dim[sensor], 3) << name;
  }
  const Module module = NoLoad().module();
  EXPECT_NEAR(system.model().body_subtreemass[0], module.m + module.m_fs, 1e-12);
}

// E a and E K written out: an annulus less six bores, of which each line's two lie at r_o.
TEST(StiffFlopMjcf, ItsStiffnessIsThatOfTheSectionWithoutItsBores) {
  const Module m = NoLoad().module();
  const SoftSegment segment = SegmentOf(m);
  const double bore = std::numbers::pi * m.r_c1 * m.r_c1, line = 2 * bore;
  const double area = m.Area() - 3 * line;
  // As the static solver counts a line: n_c bores of equal area at one place, j = (n_c a)²/(4 pi
  // n_c).
  const double second =
      m.SecondMoment() - 3 * line * line / (8 * std::numbers::pi) - 1.5 * line * m.r_o * m.r_o;
  const double d2 = m.r_2 * m.r_2;
  EXPECT_NEAR(segment.law[8], m.E * second / (m.l * d2), 1e-9 * segment.law[8]);
  EXPECT_NEAR(segment.law[10], m.E * area / m.l, 1e-9 * segment.law[10]);
  EXPECT_NEAR(segment.law[5], line, 1e-15);
}

// Small strains: at 4 kPa a line bends the module by 0.03 rad and the two models may differ by some
// of its square, the strain (2e-2) of the moved bores and the soft joint equalities.
TEST(StiffFlopMjcf, BendsAsTheStaticSolverAtSmallStrains) {
  Robot robot = NoLoad();
  robot.gravity.setZero();
  const ModelSpec system = ModelSpec::Load(kFolder + "stiff_flop.xml");
  const Change weightless{"option", "gravity[2]", 0};
  for (int line = 0; line < 3; ++line) {
    const Vector3d pressure = 4e3 * Vector3d::Unit(line);
    const Solution rod = SolveForward(robot.module(), {BodyLaw::kFixed, ChamberLaw::kFixed},
                                      {"", pressure, {Vector3d::Zero(), Vector3d::Zero()}}, false);
    ASSERT_EQ(rod.status, Status::kOk);
    const ModelAndData machine = system.Build({&weightless, 1});
    Settle(machine, pressure);
    const Vector3d tip = Sensor(machine, "tip_pos");  // world: x, -y, -z of the base
    const Vector3d expected(-rod.tip.x(), -rod.tip.z(), -rod.tip.y());
    EXPECT_LT((tip - expected).norm(), 0.03 * expected.head<2>().norm()) << "line " << line + 1;
  }
}

// All lines alike stretch the module by k_dL1 dL = 3 p A (1 + cot^2 (1 - 3 lambda^2)); pressures so
// small that a wrong sign would already show at 75 deg.
TEST(StiffFlopMjcf, ThreadsTakeFromThePressureWhatTheBraidSays) {
  const SoftSegment segment = SegmentOf(NoLoad().module());
  const double L0 = segment.law[0], A = segment.law[5], k = segment.law[10], pressure = 3e4;
  const ModelSpec system = ModelSpec::Load(kFolder + "stiff_flop_braid.xml");
  for (const double gamma : {NoLoad().module().gamma, 75 * std::numbers::pi / 180}) {
    const double cot2 = std::pow(std::tan(std::numbers::pi / 2 - gamma), 2);
    const Change changes[] = {{"option", "gravity[2]", 0}, {"plugin:threads", "cot2_gamma", cot2}};
    const ModelAndData machine = system.Build(changes);
    Settle(machine, Vector3d::Constant(pressure));
    const double stretch = Sensor(machine, "delta")[2], lambda = 1 + stretch / L0;
    const double push = 3 * pressure * A * (1 + cot2 * (1 - 3 * lambda * lambda));
    EXPECT_NEAR(k * stretch, push, 2e-3 * push) << gamma;
  }
}

TEST(StiffFlopMjcf, ALineActsFromItsDeadPressureOn) {
  const ModelSpec system = ModelSpec::Load(kFolder + "stiff_flop.xml");
  const Change dead{"actuator:p*", "biasprm[0]", -1e4};
  for (const double pressure : {5e3, 1e4, 3e4}) {
    const ModelAndData machine = system.Build({&dead, 1});
    Settle(machine, {pressure, 0, 0});
    const ModelAndData plain = system.Build();
    Settle(plain, {std::max(0.0, pressure - 1e4), 0, 0});
    EXPECT_NEAR((Sensor(machine, "delta") - Sensor(plain, "delta")).norm(), 0, 1e-12);
  }
}

TEST(StiffFlopMjcf, TheMountCarriesTheWeightAtRest) {
  const ModelAndData machine = ModelSpec::Load(kFolder + "stiff_flop.xml").Build();
  Settle(machine, {4e4, 0, 0});
  const Module module = NoLoad().module();
  EXPECT_NEAR(Sensor(machine, "base_force")[2], -(module.m + module.m_fs) * 9.81, 1e-5);
}

// As above: the upper module stands on the mount of the lower one, and the lower one carries it.
// Where it hangs its curvature is not constant: 2 % more.
TEST(StiffFlopMjcf, ModulesInSeriesBendAsTheStaticSolverAtSmallStrains) {
  Robot robot = NoLoad();
  Module upper = robot.module();
  upper.l *= 0.8;
  upper.E *= 1.3;
  robot.series = ModuleSeries({robot.module(), upper});
  robot.names = {"a", "b"};
  const ModelSpec system = ModelSpec::Parse(ModuleMjcf(robot));
  EXPECT_NEAR(system.model().body_subtreemass[0], robot.series.mass(), 1e-12);
  const Vector3d hanging = robot.gravity, none = Vector3d::Zero();
  for (const Vector3d& gravity : {none, hanging}) {
    const Change weight{"option", "gravity[2]", -gravity.y()};
    for (int line = 0; line < 6; ++line) {
      const Eigen::VectorXd pressure = 3e3 * Eigen::VectorXd::Unit(6, line);
      const Solution rod = SolveForward(robot.series, {BodyLaw::kFixed, ChamberLaw::kFixed},
                                        {"", pressure, {none, gravity}}, false);
      ASSERT_EQ(rod.status, Status::kOk);
      const ModelAndData machine = system.Build({&weight, 1});
      std::copy_n(pressure.data(), 6, machine.data->ctrl);
      while (machine.data->time < 4) mj_step(machine.model.get(), machine.data.get());
      mj_forward(machine.model.get(), machine.data.get());
      const Vector3d tip = Sensor(machine, "m2_tip_pos");
      const Vector3d expected(-rod.tip.x(), -rod.tip.z(), -rod.tip.y());
      const double share = gravity.isZero() ? 0.03 : 0.05;
      EXPECT_LT((tip - expected).norm(), share * expected.head<2>().norm()) << line;
    }
  }
}

TEST(StiffFlopMjcf, OtherLinesThanThreeAreRefused) {
  Robot robot = NoLoad();
  robot.module().lines = EvenLines(4);
  EXPECT_THROW(ModuleMjcf(robot), Error);
}

}  // namespace
}  // namespace continuum::stiff_flop
