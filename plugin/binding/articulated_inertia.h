#pragma once

#include <span>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Solves (M + h D) x = b for whole kinematic trees in a time that is linear in their joints, by
/// the inertias of articulated bodies. D here is diagonal; M as MuJoCo makes it, with the armature
/// of joints.
///
///   I_k = Σ_bodies I_b + Σ_children (I_c − U_c U_cᵀ/d_c),  U_k = I_k s_k,
///   d_k = s_kᵀ U_k + armature + h D_k                                                   (1)
///   from the tips:     e_k = b_k − s_kᵀ p_k,  p_k = Σ_children (p_c + U_c e_c/d_c)      (2)
///   from the base:     x_k = (e_k − U_kᵀ a_parent)/d_k,  a_k = a_parent + s_k x_k       (3)
///
/// k a degree of freedom, s_k its axis, I_b the inertia of a body that it moves and no other
/// between. All are 6-vectors at the centre of mass of the tree, as MuJoCo keeps them: nothing has
/// to be moved from body to body. Source: featherstone2008.
class ArticulatedInertia {
 public:
  /// Whether M is that of (1): not where tendons or actuators have armature.
  static bool Covers(const mjModel& m);
  /// dofs: all of some trees, ascending.
  ArticulatedInertia(const mjModel& m, std::span<const int> dofs);

  /// damping: h D [nv].
  void Update(const mjModel& m, const mjData& d, std::span<const double> damping);
  /// x replaces b, [dofs] both.
  void Solve(double* b);
  /// The same for four b side by side [dofs · 4].
  void SolveFour(double* b);

 private:
  static constexpr int kRow = 8;  // of six numbers, and nothing
  struct Joint {
    int dof, parent;                // parent: place among the joints, −1: none
    double axis[kRow], load[kRow];  // s, U
    double inverse;                 // 1/d
  };
  struct Body {
    int id, joint;
  };
  double* inertia(int k) { return inertia_.data() + 6 * kRow * k; }

  std::vector<Joint> joints_;
  std::vector<Body> bodies_;
  std::vector<double> inertia_;  // [joints · 6 · kRow] I
  std::vector<double> motion_;   // [joints · 4 · 6] p, then a
};

}  // namespace continuum
