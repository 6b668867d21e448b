#pragma once

#include <functional>
#include <vector>

#include "models/spa/experiment.h"

namespace continuum {

/// A recording with the motion regained from it.
struct SpaRecordedTrial {
  SpaRecording recording;
  SpaMotion motion;
};

/// The particle swarm of SpaIdentify.
struct SpaSwarm {
  int iterations = 40;
  unsigned seed = 1;
  std::function<void(int done, int of)> progress = [](int, int) {};
};

/// The paper's three steps. (1) m by least squares on the base force f_z. (2) A particle swarm over
/// x_m, y_m (within ±5 mm) and T_PT1 (0 to 30 ms), inside it linear least squares (30)-(32) on the
/// forces on δ for β = (1, d_theta, d_dL, k_theta, k_dL1, k_dL3)/A, at a constant penalty where A,
/// d_theta, d_dL, k_theta or k_dL1 comes out negative. (3) The parameters from β. Of `known` only
/// L0, d, r_ch and k_theta3 are used, and the options. The base is taken to hang at rest; the
/// filter is SpaRegain's. Throws Error::Job when every particle is infeasible.
SpaParameters<double> SpaIdentify(const SpaParameters<double>& known, const SpaOptions& options,
                                  const std::vector<SpaRecordedTrial>& trials,
                                  const SpaFilter& filter, const SpaSwarm& swarm = {});

}  // namespace continuum
