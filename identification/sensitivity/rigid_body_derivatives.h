#pragma once

#include <vector>

#include <mujoco/mujoco.h>

#include <Eigen/Core>

namespace continuum {

/// How the forces that a motion takes follow positions and speeds, in closed form, for trees of
/// hinges and slides (carpentier2018, singh2022):
///
///   τ_i = S_i · Σ_{b ≥ i} f_b,   f_b = I_b A_b + V_b ×* I_b V_b                   (1)
///   ∂τ_i/∂q_j = S_i · (I_m X_j + B_m Ψ_j [+ S_j ×* F_j where i is before j])      (2)
///   ∂τ_i/∂q̇_j = S_i · (2 I_m Ψ_j + B_m S_j)                                       (3)
///   Ψ_j = V_p × S_j,   X_j = A_p × S_j + V_p × Ψ_j                                (4)
///
/// with S the axes, V and A twists and their rates (A of the world: −g), I, B and F sums over all
/// that is distal of the deeper one m of i and j, p what j hangs on, and B Ψ the part of f linear
/// in a rigid velocity Ψ added to V. Spatial vectors are (turn, shift) about the centre of mass of
/// the tree, as MuJoCo keeps them, in SI.
class RigidBodyDerivatives {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  explicit RigidBodyDerivatives(const mjModel& m);

  /// Takes up d, after a forward pass, with the speeds v and the accelerations a [nv]; with weight,
  /// or without.
  void Update(const mjModel& m, const mjData& d, const double* v, const double* a,
              bool weighs = true);
  /// Adds ∂τ/∂q and ∂τ/∂q̇ [nv × nv] times a factor.
  void Add(double factor, Matrix& by_position, Matrix& by_velocity) const;
  /// Adds to force [nv] what inertia, added to a body in its own frame, needs: (mass [kg], mass
  /// times centre [kg m], inertia about the body's origin xx yy zz xy xz yz [kg m²]).
  void AddBody(const mjModel& m, const mjData& d, int body, const double inertia[10], double factor,
               double* force) const;
  /// Adds to force [nv] the weight of the gravity of another model less that of m, times a factor.
  void AddGravity(const mjModel& m, const mjModel& other, double factor, double* force) const;

 private:
  std::vector<int> parent_;               ///< [dof] the one before, −1: the world
  std::vector<int> last_;                 ///< [body] the last dof that moves it, −1: none
  std::vector<Vector6> axis_;             ///< [dof] S
  std::vector<Vector6> psi_;              ///< [dof] Ψ
  std::vector<Vector6> x_;                ///< [dof] X
  std::vector<Vector6> velocity_, rate_;  ///< [body] V and A
  std::vector<Vector6> force_;            ///< [body] F
  std::vector<Matrix6> inertia_;          ///< [body] I
  std::vector<Matrix6> turn_;             ///< [body] B
  std::vector<int> body_;                 ///< [dof]
};

}  // namespace continuum
