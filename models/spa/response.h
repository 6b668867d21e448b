#pragma once

#include <functional>
#include <vector>

#include "models/spa/spa.h"

namespace continuum {

/// The motion of the base at a time [s].
using SpaBaseMotion = std::function<SpaBase<double>(double)>;

/// One instant of a response; vectors in base axes.
struct SpaSample {
  double time;
  Eigen::Vector3d delta, rate, acceleration;  ///< [m], [m/s], [m/s²]
  Eigen::Vector3d pressure;                   ///< in the chambers [Pa]
  Eigen::Matrix<double, 6, 1> wrench;         ///< BaseWrench [N, N m]
  Eigen::Vector3d tip;                        ///< [m]
  double work;  ///< done on the actuator since the start by pressure and base, less damping [J]
};

struct SpaStart {
  SpaState<double> state;
  Eigen::Vector3d pressure = Eigen::Vector3d::Zero();  ///< in the chambers [Pa]
};

/// At rest in the equilibrium under the given line pressures [Pa].
SpaStart SpaAtRest(const Spa<double>& spa, const Eigen::Vector3d& pressure,
                   const SpaBase<double>& base);

/// Response to line pressures [Pa] of which input[k] is held from k·period to (k + 1)·period [s]:
/// one sample at each k·period, with the chambers lagging by T_PT1 exactly. Runge-Kutta-Fehlberg
/// 7(8) with the error per step kept below tolerance times (1 mm + |δ|, and the same per 10 ms for
/// rates). Throws Error::Job when the motion leaves |δ| < 3 L0 or L > 0.
std::vector<SpaSample> SpaRespond(const Spa<double>& spa, const SpaStart& start,
                                  const std::vector<Eigen::Vector3d>& input, double period,
                                  const SpaBaseMotion& base, double tolerance = 1e-10);

}  // namespace continuum
