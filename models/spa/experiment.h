#pragma once

#include <vector>

#include "models/spa/filter.h"
#include "models/spa/response.h"

namespace continuum {

/// Standard deviations of white noise on each sample.
struct SpaNoise {
  double tip = 0.05e-3;    ///< each axis [m]
  double pressure = 100;   ///< [Pa]
  double force = 0.01;     ///< [N]
  double torque = 0.1e-3;  ///< [N m]
};

/// What the test bench records of one step response, at a constant period [s].
struct SpaRecording {
  double period;
  std::vector<Eigen::Vector3d> pressure;            ///< in the lines before the chambers [Pa]
  std::vector<Eigen::Vector3d> tip;                 ///< in base axes [m]
  std::vector<Eigen::Matrix<double, 6, 1>> wrench;  ///< at the base [N, N m]
};

/// Motion regained from a recording, with the samples at both ends that a filter spoils cut off.
struct SpaMotion {
  std::vector<SpaState<double>> state;
  std::vector<Eigen::Vector3d> acceleration;        ///< δ̈ [m/s²]
  std::vector<Eigen::Matrix<double, 6, 1>> wrench;  ///< filtered [N, N m]
};

/// Samples cut off at each end of a SpaMotion.
inline constexpr std::size_t kSpaTrim = 50;

/// A 1 kHz recording, hanging at rest for 0.2 s and then under the given line pressures [Pa] for 1
/// s, with noise.
SpaRecording SpaRecordStep(const Spa<double>& spa, const Eigen::Vector3d& pressure,
                           const SpaNoise& noise, unsigned seed);

/// Filters the tip without phase shift, differentiates, filters and differentiates again, and maps
/// position, velocity and acceleration to δ. The shape coordinates are regular when straight, so
/// nothing near there is left out.
SpaMotion SpaRegain(const PccSegment<double>& segment, const SpaRecording& recording,
                    const SpaFilter& filter);

/// Pressures in the chambers [Pa] from those in the lines, lagging by lag [s] and then filtered and
/// cut as the motion is.
std::vector<Eigen::Vector3d> SpaChamberPressure(const SpaRecording& recording, double lag,
                                                const SpaFilter& filter);

}  // namespace continuum
