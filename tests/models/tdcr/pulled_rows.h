// The nominal robot under tensions that change from row to row, with friction that remembers.
#pragma once

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "models/tdcr/model.h"

namespace continuum::tdcr {

inline Robot Nominal() { return ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml")); }

// Directions are those that slide; the tip carries a little.
inline Loads Pull(const Robot& robot, std::vector<double> tension) {
  Loads loads = NoLoads(robot);
  loads.tension = std::move(tension);
  loads.tip_force = {0.02, 0.01, 0};
  loads.direction.assign(3, kAsItSlides);
  return loads;
}

// Tensions in equal rows from one set to another, each from the state of the row before.
inline Solution InRows(const Robot& robot, const std::vector<double>& from,
                       const std::vector<double>& to, int rows, Method method, Solution state) {
  Loads earlier = Pull(robot, from);
  for (int row = 1; row <= rows; ++row) {
    Loads load = Pull(robot, to);
    for (std::size_t k = 0; k < to.size(); ++k) {
      load.tension[k] = from[k] + (to[k] - from[k]) * row / rows;
    }
    state = SolveFrom(robot, earlier, state, load, method);
    EXPECT_TRUE(state.outcome.ok()) << row << ": " << state.outcome.why;
    earlier = load;
  }
  return state;
}

inline Eigen::Vector3d Tip(const Solution& s) { return s.disks.rightCols<1>(); }

}  // namespace continuum::tdcr
