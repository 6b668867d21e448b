#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "identification/sensitivity/model_difference.h"
#include "identification/sensitivity/native_forces.h"
#include "identification/sensitivity/rigid_body_derivatives.h"
#include "identification/sensitivity/tendon_derivatives.h"

namespace continuum {

/// The equations of motion next to a state, in closed form: with F = τ − c − M a, forces less what
/// the motion takes,
///
///   dF = ∂F/∂q dq + ∂F/∂q̇ dq̇ + ∂F/∂w dw + ∂F/∂p dp                               (1)
///
/// at fixed accelerations a; w are activations. Of hinges and slides with springs and dampers,
/// tendons through sites or of joints, and actuators with affine gain and bias that pull either.
///
/// Forces act at the speeds that are felt, q̇ + x: those of the step's end for what a method is
/// implicit in. What motion takes, c = g + Q(q̇, q̇), is of second degree in speeds; methods know its
/// first order,
///
///   c + ∂c/∂q̇ x = g + Q(q̇ + x, q̇ + x) − Q(x, x)                                   (2)
class ForceDerivatives {
 public:
  using Matrix = Eigen::MatrixXd;

  /// What a method is implicit in, each with those before it: nothing (RK4), dampers of joints
  /// (Euler), of tendons and actuators (implicitfast), the forces that motion takes (implicit).
  enum class Implicit { kNothing, kJoints, kForces, kMotion };
  static Implicit ImplicitOf(const mjModel& m);

  /// What of the forces counts, and how often.
  struct Parts {
    double springs = 1, dampers = 1, actuators = 1, motion = 1;
    bool moves = true;  ///< false: only gravity of the motion
    Implicit implicit = Implicit::kForces;
  };

  /// What a model has beyond that ("actuator 'a1' has dynamics of its own"); empty: nothing.
  static std::string Obstacle(const mjModel& m);
  explicit ForceDerivatives(const mjModel& m) : ForceDerivatives(m, Parts{}) {}
  ForceDerivatives(const mjModel& m, const Parts& parts);

  const Parts& parts() const { return parts_; }
  /// Takes up where tendons are at d, after a forward pass; before Update.
  void Place(const mjModel& m, const mjData& d) { tendons_.Update(m, d); }
  const TendonDerivatives& tendons() const { return tendons_; }
  /// What else pulls along tendons [ntendon], as given forces.
  void Pull(std::span<const double> pull) { pull_.assign(pull.begin(), pull.end()); }
  /// From now on the forces of these actuators, before their gears [nactuator], are given: only
  /// what a method knows of them at the speeds that are felt follows. NaN: they are native.
  void Give(std::vector<double> force) { given_ = std::move(force); }
  /// At d, after a forward pass; a: accelerations [nv]; felt: speeds [nv], those of d, or of the
  /// step's end, which count where the method is implicit in them; step: of lags that act early
  /// [s].
  void Update(const mjModel& m, const mjData& d, const double* a, const double* felt,
              double step = 0);
  const Matrix& by_position() const { return by_position_; }      ///< [nv × nv]
  const Matrix& by_velocity() const { return by_velocity_; }      ///< [nv × nv]
  const Matrix& by_activation() const { return by_activation_; }  ///< [nv × na]
  /// ∂F/∂q̇ as the method knows it, at the speeds of d [nv × nv].
  const Matrix& damping() const { return damping_; }

  /// force[nv] += F of another model less F, at the state and accelerations of Update; the
  /// difference has no field.
  void Differ(const mjModel& m, const mjData& d, const mjModel& other,
              const ModelDifference& difference, double* force) const;

 private:
  const std::vector<double>& FeltBy(Implicit part) const {
    return parts_.implicit >= part ? felt_ : v_;
  }
  void AddMotion(const mjModel& m, const mjData& d);
  ForceAlong Weighed(ForceAlong at_rest, double felt) const;
  ForceAlong Joint(const mjModel& by, const mjData& d, int joint) const;
  ForceAlong Tendon(const mjModel& by, const mjData& d, int tendon) const;
  ForceAlong Actuator(const mjModel& by, const mjData& d, int actuator) const;
  void PullAlong(const mjModel& m, const mjData& d, int actuator, double f, double* force) const;

  Parts parts_;
  RigidBodyDerivatives rigid_;
  std::optional<RigidBodyDerivatives> beyond_;  ///< Q(x, x) of (2)
  TendonDerivatives tendons_;
  std::vector<double> v_, a_, felt_;
  std::vector<ForceAlong> of_tendon_;
  std::vector<double> pull_, given_;
  double step_ = 0;
  Matrix by_position_, by_velocity_, by_activation_, damping_;
};

}  // namespace continuum
