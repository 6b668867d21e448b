#pragma once

#include <span>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/step_damping.h"

namespace continuum {

/// What a force changes the velocity by in a step: v⁺ = v + h (M + h D)⁻¹ force, with the damping D
/// that the integrator takes implicitly: of joints under Euler, of tendons and actuators too under
/// the implicit ones, none under RK4. What is missing in D (fluids, velocity terms of the inertial
/// forces, actuators that are not affine) only makes a force stop less than it could in one step.
class StepInertia {
 public:
  /// Of the kinematic trees that carry the given dofs; behind them stand as many ends of cables
  /// that nothing holds, with the inertia of a drag of kEndDrag.
  StepInertia(const mjModel& m, std::span<const int> dofs, int ends = 0);

  static constexpr double kEndDrag = 1e-9;  ///< [N s/m], so that a cable has next to no mass

  void Update(const mjModel& m, const mjData& d, const StepDamping& damping);

  int size() const { return static_cast<int>(dofs_.size()) + ends_; }
  const std::vector<int>& dofs() const { return dofs_; }
  /// Place of a dof among dofs().
  int index(int dof) const { return index_[dof]; }
  /// M + h D [size · size].
  const std::vector<double>& matrix() const { return matrix_; }
  /// M alone.
  void Mass(const mjModel& m, const mjData& d, std::vector<double>& mass) const;

 private:
  void Add(const StepDamping::Term& term);

  std::vector<int> dofs_, index_;
  int ends_;
  std::vector<double> matrix_;
};

}  // namespace continuum
