#pragma once

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/twin_pivot/twin_pivot.h"

/// Robots, loads and numbers for the tests of the twin-pivot robot.
namespace continuum::twin_pivot {

using Eigen::Vector3d;
using Eigen::VectorXd;

inline Robot Prototype(const std::string& name) {
  return Robot::Read(CONTINUUM_SOURCE "/models/twin_pivot/" + name + ".yaml");
}

inline Robot Weightless(Robot robot) {
  robot.m_D = robot.m_NiTi = robot.rho_cable = robot.m_CL = 0;
  return robot;
}

inline Load Pull(const std::vector<double>& tension, Condition condition = Condition::kV) {
  Load load;
  load.condition = condition;
  load.tension = tension;
  return load;
}

inline VectorXd Random(int n, double largest, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-largest, largest);
  VectorXd x(n);
  for (double& value : x) value = uniform(generator);
  return x;
}

inline std::vector<double> RandomTension(int cables, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.5, 10);
  std::vector<double> tension(cables);
  for (double& value : tension) value = uniform(generator);
  return tension;
}

/// The robots of the paper, under tensions.
class EveryPrototype : public testing::TestWithParam<const char*> {
 protected:
  Robot robot_ = Prototype(GetParam());
  int n_ = robot_.Joints();
  Load load_ = Pull(RandomTension(robot_.Cables(), 3));
};

}  // namespace continuum::twin_pivot
