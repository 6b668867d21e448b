#pragma once

#include <utility>
#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// A number of a force or torque sensor, measured and low-passed once.
struct MeasuredWrench {
  int address;  ///< in mjData::sensordata
  double unit;  ///< N or N m per unit of residuals
  std::vector<double> value;
};

/// What one log says about the motion of a model whose states are its free joints (those that no
/// linear equality ties to others), low-passed once without phase.
struct LogMotion {
  std::size_t log;
  double step, cutoff;                       ///< [s]; share of the rows' rate
  std::vector<std::vector<double>> q, v, a;  ///< [free dof][row]
  std::vector<double> noise;                 ///< [free dof] of v
  std::vector<std::pair<int, std::vector<double>>> actuator_force;  ///< actuator, measured force
  std::vector<MeasuredWrench> wrench;
  /// [free dof] of joints whose position is a column that drives an actuator of theirs, too: what
  /// moves them is not known, as of a base that a robot carries.
  std::vector<bool> prescribed;
  bool from_places = false;  ///< whether positions are those that bring frames to their places

  std::size_t rows() const { return q.front().size(); }
};

/// Positions are those of joints that are measured (jointpos); where a log measures places too
/// (framepos, framequat), all positions come from both (PositionsFromPlaces). v and a are their
/// derivatives. Of wrenches forces count, torques only where no force is measured: noise of a place
/// moves the centre of mass, which biases a mass by torques. machine: the model at the start.
/// cutoff [Hz]; 0: 50 Hz, at most a fifth of the rows' rate.
///
/// Throws Error for rows that are uneven in time, gaps, and joints that nothing measures.
LogMotion MotionOf(const Problem& problem, ModelAndData& machine, std::size_t log, double cutoff);

}  // namespace continuum
