#pragma once

#include <span>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// h D of StepInertia: what the integrator takes implicitly in a step, for the whole model. Of
/// joints and tendons with their actuators' dampers, and of affine actuators that are on and inside
/// all ranges: D that is larger than MuJoCo's would let friction throw back what it should stop.
/// Valid once actuator_force is known.
struct StepDamping {
  /// scale · J Jᵀ, of a tendon or an actuator that acts on several joints.
  struct Term {
    double scale;
    std::span<const int> dof;
    const double* J;  ///< [dof]
  };
  std::vector<double> joint;  ///< [nv] on the diagonal
  std::vector<Term> terms;

  void Update(const mjModel& m, const mjData& d);

 private:
  void AddJoints(const mjModel& m, const mjData& d);
  void AddTendons(const mjModel& m, const mjData& d);
  void AddActuators(const mjModel& m, const mjData& d);
  void Add(double scale, std::span<const int> dof, const double* J);
  bool HasJointAtRange(const mjModel& m, const mjData& d, int actuator);

  std::vector<double> tendon_;  // [ntendon] df/dv of their dampers
  std::vector<double> torque_;  // [nv] of actuators; empty: not known in this step
};

}  // namespace continuum
