#pragma once

#include "models/spa/spa.h"

namespace continuum {

/// δ [m] at rest under constant chamber pressures [Pa] with the base at rest, reached from δ = 0 by
/// Newton's method. Throws Error::Job when there is no stable equilibrium: beyond the fold of the
/// softening elongation spring, k_dL1 + 3 k_dL3 δL² = 0.
Eigen::Vector3d SpaEquilibrium(const Spa<double>& spa, const Eigen::Vector3d& pressure,
                               const SpaBase<double>& base);

}  // namespace continuum
