#pragma once

#include "models/spa/spa.h"

namespace continuum {

/// Up to which pressure in all three chambers the softening spring holds, in Pa.
///
/// The pull of an elongation x is k_dL1 x + k_dL3 x³. With k_dL3 < 0 it is largest where its slope
/// vanishes, at x_f = √(−k_dL1/(3 k_dL3)), and there (2/3) k_dL1 x_f. A straight arm along z of its
/// base, which is at rest with its axes along the world's, pulls with 3 A p + m g_z/2:
///
///   p_f = ((2/3) k_dL1 x_f − m g_z/2)/(3 A)                                                    (1)
///
/// Chambers off their centre bend the arm; then the largest pressure at rest is not (1) exactly.
double SpaStraightFold(const Spa<double>& spa);

/// By bisection: largest at which SpaEquilibrium finds rest.
double SpaLargestAtRest(const Spa<double>& spa);

/// By bisection: largest that a step from rest without pressure survives for 3 s. It is less,
/// because the step overshoots.
double SpaLargestStep(const Spa<double>& spa);

}  // namespace continuum
