#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "models/stiff_flop/log.h"

namespace continuum::stiff_flop {
namespace {

namespace fs = std::filesystem;

const fs::path kRobot = CONTINUUM_SOURCE "/models/stiff_flop/no_load.yaml";
const fs::path kLog = CONTINUUM_SOURCE "/../shared/data/stiff_flop/NoLoad.mat";

/// What a tracker would see of the model itself, turned, shifted and with the marker 12 mm out.
Log Synthetic(const Robot& robot, Registration& truth) {
  truth.turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  truth.position = {0.1, -0.2, 0.05};
  truth.along = 12e-3;
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
  EXPECT_NEAR(found.along, truth.along, 1e-5);
  EXPECT_LT(ErrorOf(found, shapes, log, 0, log.time.size()).rms, 1e-6);
}

TEST(StiffFlopLog, FitRecoversTheModulusOfASyntheticLog) {
  Robot robot = Robot::Read(kRobot);
  Registration truth;
  const Log log = Synthetic(robot, truth);
  const double E = robot.module.E;
  robot.module.E *= 1.2;
  EXPECT_TRUE(FitBraid({}, log, robot).ok());
  EXPECT_NEAR(robot.module.E, E, 1e-3 * E);
}

// 2.57 mm is the best of the physical models published for this log.
TEST(StiffFlopLog, UnfittedForwardModelIsCloserThanThePublishedOnes) {
  if (!fs::exists(kLog)) GTEST_SKIP() << "the measured log " << kLog << " is not here";
  const Robot robot = Robot::Read(kRobot);
  const Log log = Log::Read(kLog, 20);
  const std::vector<Solution> shapes = Replay(robot, {}, log);
  const Registration registration = Registration::Fit(shapes, log, TrainRows(log));
  EXPECT_LT(ErrorOf(registration, shapes, log, 0, TrainRows(log)).mean, 2.57e-3);
  const Registration all = Registration::Fit(shapes, log, log.time.size());
  EXPECT_LT(ErrorOf(all, shapes, log, 0, log.time.size()).mean, 2.57e-3);
}

}  // namespace
}  // namespace continuum::stiff_flop
