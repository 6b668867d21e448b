#pragma once

#include "models/spa/chain.h"
#include "models/spa/response.h"

namespace continuum {

/// One step response that the chain in MuJoCo and the analytic actuator both give.
struct SpaStepResponse {
  Eigen::Vector3d pressure;  ///< in the lines from 20 ms on [Pa], zero before
  bool moving = false;  ///< the base swings in all six coordinates (SpaSwing), else it is fixed
  int links = 10;
  double timestep = 2e-4;  ///< at most 1 ms or one or two of them [s]
  bool rk4 = true;         ///< else as the MJCF says
  double duration = 1;     ///< [s]
  double evenness = std::numeric_limits<double>::infinity();  ///< SoftChain's s
};

/// Largest distance between the two over the trial, as a share of the range that the quantity's
/// widest component covers in the analytic response.
struct SpaGap {
  double delta, tip;     ///< δ; tip against the base, in base axes
  double force, torque;  ///< native sensors against the balance of momentum
};

/// Throws Error::Job when the chain diverges.
SpaGap ChainError(const SpaFile& file, const SpaStepResponse& trial);

/// Hanging, with sinusoids of 0.02 m and 0.2 rad at 1, 1.6, .. 4 Hz in x, y, z, α, β, γ.
SpaBaseMotion SpaSwing();

}  // namespace continuum
