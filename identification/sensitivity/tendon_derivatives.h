#pragma once

#include <span>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include <Eigen/Core>

namespace continuum {

/// Derivatives of tendons' moment arms with respect to positions: with u a segment's direction, l
/// its length and e_i = ∂(far − near)/∂q_i,
///
///   ∂L/∂q_i = Σ u · e_i                                                          (1)
///   ∂²L/∂q_i∂q_j = Σ (e_i · e_j − (u · e_i)(u · e_j))/l + u · ∂e_i/∂q_j           (2)
///
/// over the segments of a path through sites on hinges and slides, each moved only by the joints
/// between its two ends. Tendons of joints have no second derivative.
class TendonDerivatives {
 public:
  using Matrix = Eigen::MatrixXd;

  /// What keeps a model's tendons from it ("tendon 't1' wraps around a geom"); empty: nothing.
  static std::string Obstacle(const mjModel& m);
  /// The same of a step that is implicit in damping: MuJoCo's methods know how it couples joints of
  /// which one moves the other, and take that of others, as of two fingers, at the speeds before
  /// the step.
  static std::string DampingObstacle(const mjModel& m);
  explicit TendonDerivatives(const mjModel& m);

  /// At d, after a forward pass.
  void Update(const mjModel& m, const mjData& d);
  /// dL/dt at velocities [nv].
  double Rate(const mjModel& m, const mjData& d, int tendon, const double* v) const;
  /// force[nv] += f ∂L/∂q.
  void ForceAlong(const mjModel& m, const mjData& d, int tendon, double f, double* force) const;
  /// bend[nv] += factor ∂²L x.
  void AddBend(int tendon, double factor, const double* x, std::span<double> bend) const;
  /// The same of single segments, numbered from the first site on: weight[segments].
  void AddBends(int tendon, std::span<const double> weight, const double* x,
                std::span<double> bend) const;
  /// curvature [nv × nv] += Σ weight ∂²L of the segments.
  void AddCurvature(int tendon, std::span<const double> weight, Matrix& curvature) const;
  /// Adds of a pull f(L, L̇) along a tendon what follows positions and speeds [nv × nv]:
  ///   f_L ∂L/∂q ∂L/∂qᵀ + f_L̇ ∂L/∂q (v ∂²L)ᵀ + f ∂²L   and   f_L̇ ∂L/∂q ∂L/∂qᵀ    (3)
  void Add(const mjModel& m, const mjData& d, int tendon, double f, double by_length,
           double by_rate, const double* v, Matrix& by_position, Matrix& by_velocity);

 private:
  struct JointTerm {
    int dof;
    double sign;  ///< 1: it moves the far end, −1: the near one
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();      ///< of the joint, 0 for a slide
    Eigen::Vector3d jacobian = Eigen::Vector3d::Zero();  ///< e_i
    double moment_arm = 0;                               ///< u · e_i
  };
  struct Segment {
    int near, far;                       ///< sites
    int place;                           ///< along the tendon
    std::vector<JointTerm> joints = {};  ///< of each side from the root on
    double length = 0;
    Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< u
  };
  /// Calls fn(i, j, ∂²L/∂q_i∂q_j, place) for all j up to i of every segment; neither twice.
  template <class Fn>
  void ForEachCurvature(int tendon, Fn&& fn) const;

  std::vector<std::vector<Segment>> route_;  ///< [tendon]
  std::vector<double> bent_;                 ///< [nv] v ∂²L
};

}  // namespace continuum
