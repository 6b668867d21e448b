#pragma once

#include "models/spa/chain.h"

namespace continuum {

/// How a chain rests without gravity under a small force across its tip, beside the closed form.
///
/// Bending stiffness k = k_theta d², node k of N at the fraction t_k of the length L0, with the
/// share w_k of the bend U (half of that of the others at both ends). V of SoftChain is least where
///
///   x_k = w_k U (1 + (1 − 2 t_k)/s),   U = F L0/(2k)                                           (1)
///   sag = Σ x_k L0 (1 − t_k) = (F L0²/k) (1/4 + (1/12 + 1/(6N²))/s)                            (2)
///
/// s = ∞: one arc. s = 1: a cantilever, F L0³/(3EI) with EI = k L0 up to the N²; its curvature is
/// twice the mean at the mount and none at the tip.
struct SpaSideForce {
  double sag, closed_form;  ///< of the tip, in F L0²/k
  double mount, tip;        ///< curvature there, over the mean
};

/// Throws Error as SpaMjcf does, Error::Job when the chain diverges. force [N].
SpaSideForce PushAcross(const SpaFile& file, const SpaLayout& layout, double force);

}  // namespace continuum
