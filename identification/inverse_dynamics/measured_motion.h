#pragma once

#include <map>
#include <vector>

#include <mujoco/mujoco.h>
#include <Eigen/Core>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Rows on either side of one whose quartic is fitted, and in all.
inline constexpr std::size_t kHalfRows = 5, kQuarticRows = 2 * kHalfRows + 1;

/// The quartic through the rows around one row, as weights of their values.
struct Quartic {
  std::size_t begin;  ///< the first of these rows
  Eigen::VectorXd value, slope, curvature;
  /// Of mean accelerations from each of these rows to the next: what the curvature is a mean of
  /// (missing_force.h, 2).
  Eigen::VectorXd mean;

  Quartic(const std::vector<double>& time, std::size_t row);
  /// The same around another row of evenly spaced ones.
  Quartic At(std::size_t row) const;
  double Of(const std::vector<double>& y, const Eigen::VectorXd& weights) const;
};

/// One for each row of a log but for the kHalfRows at either end.
std::vector<Quartic> QuarticsOf(const std::vector<double>& time);

/// The channel that measures each joint's position, of those joints that have one.
std::map<int, std::size_t> JointChannels(const Experiment& e, const mjModel& m);

/// A joint's position, speed and acceleration at the rows of the quartics.
struct JointMotion {
  std::vector<double> angle, velocity, acceleration;
};

/// Of every measured joint of a log, as e measures it.
std::map<int, JointMotion> MotionsOf(const Experiment& e, const mjModel& m, const Log& log,
                                     const std::vector<Quartic>& quartics);

}  // namespace continuum
