#pragma once

#include <span>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// h D of StepInertia: what the integrator takes implicitly in a step, for the whole model.
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
  void Add(double scale, std::span<const int> dof, const double* J);
};

}  // namespace continuum
