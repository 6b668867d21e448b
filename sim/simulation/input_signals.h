#pragma once

#include <cstddef>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Switches an actuator on and off as its enable column says. Off, gain and bias are zero: the
/// actuator gives neither torque nor back-EMF.
class Gate {
 public:
  Gate(mjModel& m, int actuator);
  void Switch(bool on);

 private:
  double* Gain() const { return m_->actuator_gainprm + mjNGAIN * a_; }
  double* Bias() const { return m_->actuator_biasprm + mjNBIAS * a_; }

  mjModel* m_;
  int a_;
  std::vector<double> gain_, bias_;
};

/// Writes the inputs of one log into the controls of a simulation (mjData::ctrl).
class Inputs {
 public:
  Inputs(mjModel& m, const Experiment& e, const Log& log, const Wiring& wiring);

  /// Sets all controls to the values of a row, and switches actuators as its enable columns say.
  void AtRow(mjData& d, std::size_t row);
  /// Sets the controls that are interpolated linearly to their value at a time t of the log [s],
  /// between a row and the next.
  void Interpolate(mjData& d, std::size_t row, double t) const;
  /// Sets all controls (held ones too) to from + share (u − from), with u the values of row `to`
  /// and share from 0 to 1. from: [inputs].
  void Blend(mjData& d, const std::vector<double>& from, std::size_t to, double share) const;
  /// Switches actuators on and off as the enable columns of a row say.
  void Switch(std::size_t row);
  void EnableAll();

 private:
  const Experiment& experiment_;
  const Log& log_;
  const Wiring& wiring_;
  std::vector<Gate> gates_;
};

/// Brings lags and delays of actuators and effects to their steady state under the present
/// controls, clamped as the engine clamps them.
void Settle(const mjModel& m, mjData& d);

}  // namespace continuum
