#pragma once

#include <string>
#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// What the model lacks, as a generalized force on one joint, at the rows of the logs:
///
///   missing = (M (a_measured − F a_model))_j                             (1)
///
/// with the model's acceleration at the measured states and its mass matrix M. Angles, speeds and
/// a_measured come from a quartic through 11 rows; its second derivative is a mean of the true
/// acceleration over those rows,
///
///   ÿ_fit(t_k) = Σ c_i y_i = ∫ w(s) ÿ(s) ds,   w(s) = Σ c_i max(0, t_i − s),   (2)
///
/// and F takes the same mean of the model's, so that neither fast motion nor an input that jumps
/// looks like a missing force. An equation error: no simulation drifts in it. The five rows at each
/// end of a log are left out.
struct MissingForce {
  std::string joint;
  std::vector<std::string> at_rest;  ///< joints that are not measured, and that nothing moves
  bool slides = false;               ///< the joint: m and N, else rad and N m
  std::vector<std::size_t> log;
  std::vector<double> time, angle, velocity, load, force;  ///< SI
  std::vector<double> weight;        ///< what gravity does at the joint [N*m or N]
  std::vector<double> acceleration;  ///< a_measured − F a_model: what noise there is, is added
};

/// Missing forces, or accelerations, of all joints below each other, each joint's in units of its
/// own (root of the sum of squares) where this was made; 1 where it has none there.
class StackedForces {
 public:
  using Kind = std::vector<double> MissingForce::*;
  StackedForces() = default;
  StackedForces(const std::vector<MissingForce>& joints, Kind kind);

  /// Of the same joints, logs and rows.
  Problem::Vector Of(const std::vector<MissingForce>& joints) const;
  Eigen::Index size() const { return size_; }
  double unit(std::size_t joint) const { return unit_[joint]; }

 private:
  Kind kind_ = nullptr;
  std::vector<double> unit_;  // [joint]
  Eigen::Index size_ = 0;
};

/// Whether every joint is measured in all rows of a log, which are enough.
bool MeasuresEveryJoint(const Problem& problem, std::size_t log);

/// On every measured joint, of the logs in use; none when not every joint is measured in all their
/// rows. A hinge or slide that is not measured counts as at rest where the model leaves it there,
/// as those across the plane in which an arm moves. step: of the model's motion between rows [s],
/// 0: its own.
std::vector<MissingForce> MissingForces(const Problem& problem, const Problem::Vector& x,
                                        const std::vector<bool>& use, double step = 0);

/// The joint on which most is missing, over all logs; empty joint when not every joint is measured.
MissingForce FindMissingForce(const Problem& problem, const Problem::Vector& x);

}  // namespace continuum
