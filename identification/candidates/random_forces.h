#pragma once

#include <cstdint>

#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// count smooth random functions of a joint's angle, speed and (loaded) actuator torque, the same
/// on every hinge and slide joint:
///
///   τ_j = Σ_k θ_k cos(a_k q_j/s_q + b_k v_j/s_v + l_k τ_act,j/s_τ + c_k)
///
/// with a, b, l standard normal, c uniform: what a law that names no cause could do. Repeats
/// exactly for a seed.
ForceTerms RandomForce(std::size_t count, bool loaded, const Sizes& sizes, std::uint64_t seed);

/// The same with the direction of motion, tanh(10 v_j/s_v), in place of the speed: what a dry
/// friction could do whose level varies with angle and load.
ForceTerms RandomFriction(std::size_t count, const Sizes& sizes, std::uint64_t seed);

}  // namespace continuum
