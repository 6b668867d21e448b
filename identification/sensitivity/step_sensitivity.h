#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "identification/sensitivity/force_derivatives.h"
#include "identification/sensitivity/sensor_derivatives.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Derivatives of MuJoCo's own steps (implicitfast) with respect to parameters, in closed form.
/// With F of ForceDerivatives, D what the method knows of ∂τ/∂q̇ and f the forces of dry friction,
///
///   M a = F₀ + f,   (M − h D) a* = F₀ + f,   q̇⁺ = q̇ + h a*,   q⁺ = q + h q̇⁺       (1)
///
/// are two equations for the step: the solver's a, which f follows, and a* of the method, whose
/// forces are those of F at the speeds q̇⁺. Of a joint with dry friction, f is its level where it
/// slides, and where it rests the spring and damper of the solver, f = −R⁻¹ (a + B q̇), so that by
/// the implicit function theorem
///
///   (M + R⁻¹) da = dF(a) − R⁻¹ B dq̇ + …,   (M − h D) da* = dF(a*) + df             (2)
///
/// Which joints slide is taken from the step.
class StepSensitivity {
 public:
  using Matrix = Eigen::MatrixXd;

  /// What keeps a model from it ("the integrator is RK4"); empty: nothing.
  static std::string Obstacle(const mjModel& m, const Wiring& wiring);

  /// perturbed: the same machine with one parameter moved; move: as ContinuousSensitivity has it.
  StepSensitivity(const mjModel& m, const Wiring& wiring, std::vector<const mjModel*> perturbed,
                  double move);
  /// Whether a perturbed model differs by what the closed form knows.
  bool Covers(std::size_t k) const { return covered_[k]; }
  /// The state from which a covered perturbed model starts less the machine's, by the move.
  void Start(std::size_t k, const std::vector<double>& dq, const std::vector<double>& dv,
             const std::vector<double>& dw);

  /// Around every step: takes up the state it starts from; follows it. False: it has no closed
  /// form, as a row of the constraint solver acts that is no joint's friction.
  void Before(const mjModel& m, const mjData& d);
  bool After(const mjModel& m, mjData& d);
  /// Lets recorders [perturbed model] see a row, with d as a step that began there, or a forward
  /// pass, has left it.
  void Observe(const mjModel& m, mjData& d, std::size_t row, std::span<Recorder> recorders);

 private:
  struct FrictionRow {
    int row, dof;
    bool slides;
  };
  bool FindRows(const mjData& d);
  void Derive(const mjModel& m, const mjData& d, const double* a, const double* felt,
              Matrix& force);
  bool AddFriction(const mjModel& m, const mjData& d, Matrix& force);
  bool Follow(const mjModel& m, const mjData& d);
  void FollowLags(const mjModel& m, const mjData& d);
  void SwapState(mjData& d);

  std::vector<const mjModel*> perturbed_;
  double move_;
  std::vector<bool> covered_;
  std::vector<std::size_t> columns_;
  std::vector<ModelDifference> differences_;
  ForceDerivatives derivatives_;
  SensorDerivatives sensors_;
  std::vector<FrictionRow> friction_rows_;
  std::vector<double> q_, v_, w_, after_, a_;  ///< of Before; a*
  Matrix dq_, dv_, dw_;                        ///< [·, covered]
  Matrix inertia_, force_, answer_, work_;
  Eigen::LLT<Matrix> factor_;
};

}  // namespace continuum
