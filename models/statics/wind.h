#pragma once

#include "models/statics/reach.h"

namespace continuum::statics {

/// The lengths of cables that bring the target's coordinates to their values, from lengths near by:
/// Newton's method by steps of least change,
///
///   L <- L + (dp/dL)^+ (p* - p(L))                                                            (1)
///
/// made shorter where they come no nearer. `stand`: what stands under lengths [m]; its slopes are
/// by them. `ok` within 1e-6 of the robot's length; drives are the lengths.
Reached Wind(const StandUnder& stand, Eigen::VectorXd lengths, const Target& target, double length);

/// Lengths with room of 1 % for cables without tension, so that they stay slack on the way there.
Eigen::VectorXd WithRoom(const Eigen::VectorXd& lengths, const Eigen::VectorXd& tension);

/// What to say where taut cables that do not stretch have no tensions of their own: `low` of the
/// target is above 0. Nothing else.
std::optional<Reached> NoPretension(const Target& target, double EA);

}  // namespace continuum::statics
