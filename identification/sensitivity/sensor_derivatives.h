#pragma once

#include <string>
#include <vector>

#include "sim/simulation/simulate.h"
#include "sim/simulation/wiring.h"

#include <Eigen/Core>

namespace continuum {

/// Derivatives of the sensors of an experiment's outputs with respect to positions and speeds [nv],
/// in closed form, on hinges and slides: positions and speeds of joints, and where frames are in
/// the world.
class SensorDerivatives {
 public:
  /// What keeps an output from being known at a state ("sensor 'y'"); empty: nothing.
  static std::string Obstacle(const mjModel& m, const Wiring& wiring);
  /// Whether all outputs are made of these; others need MovedSensors.
  static bool Cover(const mjModel& m, const Wiring& wiring);
  /// Of the sensors that they cover.
  SensorDerivatives(const mjModel& m, const Wiring& wiring);

  /// At d, whose positions' frames and axes (mj_comPos) are known.
  void Update(const mjModel& m, const mjData& d);
  /// Adds to d's sensors what they change as positions and speeds do; takes it back.
  void Move(mjData& d, const double* dq, const double* dv);
  /// The same as frames are elsewhere in another model at the same positions; after Move.
  void MoveFrames(const mjModel& m, mjData& d, const mjData& there) const;
  void Back(mjData& d) const;

 private:
  struct Read {
    int sensor, address, size;
    int dof;  ///< of a joint's; −1: a frame
    bool speed;
  };
  std::vector<Read> reads_;
  std::vector<Eigen::Matrix3Xd> jacobian_;  ///< [read] of frames, ∂p/∂q
  std::vector<double> was_;
};

}  // namespace continuum
