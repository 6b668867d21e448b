#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Joints that linear joint equalities tie to others, taken out exactly:
///
///   q = q₀ + o + S (ξ − ξ₀),   v = S w                                          (1)
///   Sᵀ M S ẇ = Sᵀ (τ − c)                                                       (2)
///
/// with ξ the positions and w the velocities of the free joints, q₀ and ξ₀ those of qpos0, and τ,
/// c, M of MuJoCo's forward dynamics. Forces of the ties do no work on (1), so (2) lacks them. A
/// joint hangs on at most one other: a row of S has at most one entry.
class JointEqualities {
 public:
  /// Of the equalities that are active at the start; without any, every joint is free.
  explicit JointEqualities(const mjModel& m);

  /// What (1) cannot say ("equality 'e' is not linear"); empty: nothing.
  const std::string& obstacle() const { return obstacle_; }
  bool none() const { return dofs_.size() == column_.size(); }
  /// How many entries of qpos and qvel are free.
  std::size_t positions() const { return positions_.size(); }
  std::size_t velocities() const { return dofs_.size(); }
  /// The free entries of qvel.
  const std::vector<int>& dofs() const { return dofs_; }

  /// Of vectors as long as qpos or qvel to the free entries.
  void FreePositions(const double* all, double* free) const;
  void FreeVelocities(const double* all, double* free) const;
  /// Sets qpos and qvel from the free entries, by (1).
  void Spread(const mjModel& m, const double* position, const double* velocity, mjData& d) const;
  /// Sᵀ f, of a force on every joint [qvel] the one on the free ones.
  void Project(const double* force, double* free) const;
  /// Sets qacc by (2) where a forward pass without constraints has been made.
  void Accelerate(const mjModel& m, mjData& d);

 private:
  struct Tie {
    int on;  ///< the free joint; kHeld: none
    double offset, ratio;
  };
  static constexpr int kHeld = -1;
  void Join(const mjModel& m, int equality);
  void Replace(int joint, const Tie& by);
  std::string Called(const mjModel& m, int equality) const;

  std::vector<Tie> tie_;        ///< [joint]
  std::vector<int> positions_;  ///< free entries of qpos
  std::vector<int> dofs_;
  std::vector<int> column_;    ///< [dof] its entry's column in S, or kHeld
  std::vector<double> entry_;  ///< [dof]
  std::string obstacle_;
  std::vector<double> inertia_, reduced_, force_, rate_;  ///< M, Sᵀ M S, Sᵀ (τ − c), ẇ
};

}  // namespace continuum
