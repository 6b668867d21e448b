#pragma once

#include <mujoco/mujoco.h>
#include <Eigen/Core>

namespace continuum {

/// The mass of a body [kg]: of its specification where that says so, else what compilation found in
/// its geoms. compiled: the compiled model of the same specification.
double BodyMass(const mjSpec& spec, const mjsBody& body, const mjModel& compiled);

/// Gives a body another mass [kg]; its inertia is scaled with it. Throws Error when the compiler of
/// the specification overrides masses.
void SetBodyMass(const mjSpec& spec, mjsBody& body, const mjModel& compiled, double mass);

/// Adds a point mass [kg] at the body's origin: centre and inertia by the parallel-axis theorem.
/// Throws Error as SetBodyMass does.
void AddPointMass(const mjSpec& spec, mjsBody& body, const mjModel& compiled, double added);

/// Moves every point of a body's mass, x → b + A x in the axes of the body. Throws Error as
/// SetBodyMass does.
void MapBodyMass(const mjSpec& spec, mjsBody& body, const mjModel& compiled,
                 const Eigen::Matrix3d& A, const Eigen::Vector3d& b);

}  // namespace continuum
