// ctest labels: real-data
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "models/stiff_flop/lines.h"
#include "support/recordings.h"

namespace continuum::stiff_flop {
namespace {

namespace fs = std::filesystem;

const fs::path kRobot = CONTINUUM_SOURCE "/models/stiff_flop/no_load.yaml";

/// What a tracker would see of the model itself, turned, shifted and with the marker off the tip.
Log Synthetic(const Robot& robot, Registration& truth) {
  truth.turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  truth.position = {0.1, -0.2, 0.05};
  truth.offset = {5e-3, 12e-3, -14e-3};
  Log log;
  for (int i = 0; i < 6; ++i) {
    log.time.push_back(7 + 4 * i);
    log.pressure.push_back(4e4 * Eigen::Vector3d(i == 0 || i == 3, i == 1, i == 2 || i == 3));
  }
  for (const Solution& shape : Replay(robot, {}, log)) log.marker.push_back(truth.Marker(shape));
  return log;
}

TEST(StiffFlopLog, RegistrationRecoversWhereTheTrackerStands) {
  const Robot robot = Robot::Read(kRobot);
  Registration truth;
  const Log log = Synthetic(robot, truth);
  const std::vector<Solution> shapes = Replay(robot, {}, log);
  const Registration found = Registration::Fit(shapes, log, log.time.size());
  EXPECT_LT((found.turn - truth.turn).norm(), 1e-3);
  EXPECT_LT((found.position - truth.position).norm(), 1e-4);
  EXPECT_LT((found.offset - truth.offset).norm(), 1e-5);
  EXPECT_LT(ErrorOf(found, shapes, log, 0, log.time.size()).rms, 1e-6);
}

TEST(StiffFlopLog, FitRecoversTheModulusOfASyntheticLog) {
  Robot robot = Robot::Read(kRobot);
  Registration truth;
  const Log log = Synthetic(robot, truth);
  const double E = robot.module().E;
  robot.module().E *= 1.2;
  EXPECT_TRUE(FitBraid({}, log, robot).ok());
  EXPECT_NEAR(robot.module().E, E, 1e-3 * E);
}

TEST(StiffFlopLines, AStepActsBeyondTheDeadPressureAndItsShareOfCreepFollows) {
  Lines lines;
  lines.gain = {1, 2, 1};
  lines.dead = 1e4, lines.creep = 0.2, lines.lag = 2;
  Log log;
  for (int i = 0; i < 200; ++i) {
    log.time.push_back(0.1 * i);
    log.pressure.push_back(i == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(0, 4e4, 5e3));
  }
  const Log acting = lines.Acting(log);
  EXPECT_EQ(acting.pressure[50].x(), 0);
  EXPECT_EQ(acting.pressure[50].z(), 0);
  const double q = 2 * (4e4 - 1e4), h = 0.1;
  // The rise takes one row: what creeps is q t/h until then, so z(h) = q (1 - (lag/h)(1 -
  // e^-h/lag)).
  const double z = q * (1 - lines.lag / h * (1 - std::exp(-h / lines.lag)));
  EXPECT_NEAR(acting.pressure[1].y(), 0.8 * q + 0.2 * z, 1e-9 * q);
  EXPECT_NEAR(acting.pressure[100].y(), 0.8 * q + 0.2 * (q + (z - q) * std::exp(-9.9 / 2)),
              1e-9 * q);
}

TEST(StiffFlopLines, FitRecoversTheDeadPressureOfASyntheticLog) {
  const Robot robot = Robot::Read(kRobot);
  Registration truth;
  Log log = Synthetic(robot, truth);
  Lines real;
  real.gain = {1, 0.9, 1.1};
  real.dead = 5e3;
  const Log acting = real.Acting(log);
  const std::vector<Solution> shapes = Replay(robot, {}, acting);
  for (std::size_t i = 0; i < shapes.size(); ++i) log.marker[i] = truth.Marker(shapes[i]);
  Lines found{real.gain, 2e3, 0, 2};
  FitLines(robot, {}, log, {false, true, false}, found);
  EXPECT_NEAR(found.dead, real.dead, 10);
}

// 2.57 mm is the best of the physical models published for this log.
TEST(StiffFlopLog, UnfittedForwardModelIsCloserThanThePublishedOnes) {
  const fs::path measured = testing::Recordings("stiff_flop") / "NoLoad.mat";
  if (!fs::exists(measured)) GTEST_SKIP() << "no recordings at " << measured;
  const Robot robot = Robot::Read(kRobot);
  const Log log = Log::Read(measured, 20);
  const std::vector<Solution> shapes = Replay(robot, {}, log);
  const Registration registration = Registration::Fit(shapes, log, TrainRows(log));
  EXPECT_LT(ErrorOf(registration, shapes, log, 0, TrainRows(log)).mean, 2.57e-3);
  const Registration all = Registration::Fit(shapes, log, log.time.size());
  EXPECT_LT(ErrorOf(all, shapes, log, 0, log.time.size()).mean, 2.57e-3);
}

}  // namespace
}  // namespace continuum::stiff_flop
