#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "identification/sensitivity/actuator_derivatives.h"
#include "identification/sensitivity/cable_derivatives.h"
#include "identification/sensitivity/effect_derivatives.h"
#include "identification/sensitivity/force_derivatives.h"
#include "identification/sensitivity/moved_sensors.h"
#include "identification/sensitivity/runge_kutta_stages.h"
#include "identification/sensitivity/sensor_derivatives.h"
#include "identification/sensitivity/single_steps.h"
#include "identification/sensitivity/solver_rows.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Derivatives of MuJoCo's own steps (Euler, implicitfast, implicit, RK4) with respect to
/// parameters, in closed form. With F of ForceDerivatives, E the forces of effects, D what the
/// method knows of ∂F/∂q̇ and f the forces of the constraint solver,
///
///   M a = F₀ + E + Jᵀ f,   (M − h D) a* = F₀ + E + Jᵀ f,   q̇⁺ = q̇ + h a*,   q⁺ = q + h q̇⁺   (1)
///
/// are two equations for the step: the solver's a, which f follows (SolverRows), and a* of the
/// method, whose forces are those of F felt at the speeds q̇⁺. D is symmetric but for what
/// `implicit` knows of the motion's forces. To first order
///
///   (M + Σ_hold D_r JᵀJ) da = dF(a) + dE + Jᵀ df,   (M − h D) da* = dF(a*) + dE + Jᵀ df (2)
///
/// RK4 knows no D: a is that of each of its stages, which follow each other as RungeKuttaStages has
/// it, and so do their derivatives.
///
/// States of effects are states like others: their next values follow what their laws read. What
/// parameters change that are none of F's own, as geometry, is known from SingleSteps.
class StepSensitivity {
 public:
  using Matrix = Eigen::MatrixXd;

  /// What keeps a model from it ("the integrator is discrete"); empty: nothing.
  static std::string Obstacle(const mjModel& m, const mjData& d, const Wiring& wiring);

  /// perturbed: the same machine with one parameter moved; move: as ContinuousSensitivity has it;
  /// mirrored: the parameters of perturbed models moved the other way, empty or null: at a bound.
  StepSensitivity(const ModelAndData& machine, const Wiring& wiring,
                  const std::vector<const ModelAndData*>& perturbed, double move,
                  const std::vector<const ModelAndData*>& mirrored = {});
  /// Why a perturbed model cannot be followed ("it changes a size of the model (nsite)"); empty: it
  /// can.
  const std::string& WhyNot(std::size_t k) const { return why_not_[k]; }
  bool Covers(std::size_t k) const { return why_not_[k].empty(); }
  /// The state from which a covered perturbed model starts less the machine's, by the move.
  struct State {
    std::vector<double> q, v, w, z;  ///< positions, speeds, activations, states of effects
  };
  void Start(std::size_t k, const State& difference);

  /// Around every step: takes up the state it starts from; follows it. False: it has no closed
  /// form, as there is a row of the constraint solver that SolverRows does not know, above all.
  void Before(const mjModel& m, const mjData& d);
  bool After(const mjModel& m, mjData& d);
  /// Why After returned false ("a contact acts at 0.31 s"); empty: it has not.
  const std::string& failure() const { return failure_; }
  /// Lets recorders [perturbed model] see a row, with d as a step that began there, or a forward
  /// pass, has left it.
  void Observe(const mjModel& m, mjData& d, std::size_t row, std::span<Recorder> recorders);

  /// What states change by: positions, speeds, states of effects [number, covered perturbed model].
  const NumberTangents& numbers() const { return *numbers_; }
  const Tangents& activation() const { return activation_; }

 private:
  void FollowTendons(const mjModel& m, const mjData& d);
  bool FollowActuators(const mjModel& m, mjData& d);
  bool FollowEffects(const mjModel& m, mjData& d);
  void FollowCable(const mjModel& m, const mjData& d);
  void FollowLoad(const mjModel& m, const mjData& d, Number::Kind torque);
  void AddEffects(const mjModel& m, const mjData& d, double factor, Tangents& force) const;
  void Differ(const mjModel& m, const mjData& d, const ForceDerivatives& derivatives,
              Tangents& force);
  void Derive(const mjModel& m, const mjData& d, const double* a, const double* felt,
              Tangents& force);
  bool FollowRows(const mjModel& m, const mjData& d);
  bool Solve(Tangents& force);
  bool Fail(std::string why);
  bool FollowStep(const mjModel& m, mjData& d);
  bool FollowStages(const mjModel& m);
  bool FollowForces(const mjModel& m, mjData& d);
  bool FollowMethod(const mjModel& m, const mjData& d);
  StepTaken Taken();
  Tangents RateOfActivations(const mjModel& m, const mjData& d) const;
  void FollowActivations(const mjModel& m, const Tangents& rates);
  void Advance(const mjModel& m, const mjData& d);
  void SwapState(mjData& d);
  Tangents& Of(Number::Kind kind) { return (*numbers_)[kind]; }
  const Tangents& Of(Number::Kind kind) const { return (*numbers_)[kind]; }

  std::vector<const ModelAndData*> perturbed_;  ///< those that are covered; the machine for steps_
  double move_;
  std::vector<std::string> why_not_;  ///< [perturbed model]
  std::string failure_;
  std::vector<std::size_t> columns_;
  std::vector<ModelDifference> differences_;
  SingleSteps steps_;
  ForceDerivatives derivatives_;
  ForceDerivatives transmitted_, motors_;  ///< what loads gears
  SensorDerivatives sensors_;
  std::optional<MovedSensors> moved_sensors_;  ///< where these do not cover all outputs
  std::optional<EffectDerivatives> effects_;
  std::optional<SolverRows> rows_;
  std::optional<NumberTangents> numbers_;
  std::optional<ActuatorDerivatives> actuators_;  ///< where effects read or change them
  std::optional<CableDerivatives> cable_;         ///< where a law has friction of cables
  std::vector<double> given_;                     ///< forces that signals change, else NaN
  Tangents activation_;                           ///< dw
  std::optional<RungeKuttaStages> stages_;
  std::vector<double> q_, v_, w_, z_, u_, after_, a_;  ///< of Before; a*
  std::vector<double> q_after_, w_change_, pull_;
  Matrix inertia_, differ_;
  Tangents force_, answer_;
  Eigen::LLT<Matrix> factor_;
};

}  // namespace continuum
