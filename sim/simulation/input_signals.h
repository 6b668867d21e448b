#pragma once

#include <cstddef>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Gain and bias of an actuator with an enable column, so that "off" can take them away: neither
/// torque nor back-EMF.
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

/// The inputs of one log on one machine.
class Inputs {
 public:
  Inputs(mjModel& m, const Experiment& e, const Log& log, const Wiring& wiring);

  /// The values of a row, its enable columns included.
  void AtRow(mjData& d, std::size_t row);
  /// Between a row and the next, at a time of the log [s]: only what is linear there.
  void Between(mjData& d, std::size_t row, double t) const;
  /// Of all inputs (held ones too), a share of the way from one row's values to another's.
  void OnTheWay(mjData& d, const std::vector<double>& from, std::size_t to, double share) const;
  /// The enable columns of a row.
  void Switch(std::size_t row);
  void AllOn();

 private:
  const Experiment& experiment_;
  const Log& log_;
  const Wiring& wiring_;
  std::vector<Gate> gates_;
};

/// Lags and delays as if the present inputs, as the engine clamps them, had been there for ever.
void Settle(const mjModel& m, mjData& d);

}  // namespace continuum
