#pragma once

#include <span>
#include <string>
#include <vector>

#include "identification/sensitivity/cable_derivatives.h"
#include "identification/sensitivity/number_tangents.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// How the laws of a model's effects follow state and parameters, by the derivatives that each law
/// has of itself (BoundLaw::Differentiate).
class EffectDerivatives {
 public:
  /// Which effect has no slopes, and why ("effect 'soft': …"); empty: all have.
  static std::string Obstacle(const mjModel& m, const mjData& d);

  /// move: what differences of the perturbed models are to be divided by.
  EffectDerivatives(const ModelAndData& machine, std::span<const ModelAndData* const> perturbed,
                    double move);

  /// Effects that change inputs of actuators, then their forces, then what the others do.
  enum class Group { kInputs, kDrives, kOthers };
  /// Those of the step that has been taken. d: after it, with the positions and speeds before it;
  /// step: with the states of all plugins before it [npluginstate].
  void Update(Group group, const mjModel& m, const mjData& d, const StepTaken& step);
  /// Whether effects read or change what actuators give.
  bool uses_actuators() const { return uses_actuators_; }
  /// Writes NaN for actuators that no signal changes [nactuator].
  void KeepGiven(std::span<double> force) const;
  /// The effect of cables' friction; none: law is null. state: as in Update.
  CableDerivatives::Law Cable(const mjModel& m, const mjData& d, const double* state) const;
  /// Adds to pull [ntendon] what the laws pull along tendons.
  void AddPulls(std::span<double> pull) const;

  Eigen::Index parameters() const { return parameters_.rows(); }
  /// Writes the tangents that no step changes: parameters, rests of springs.
  void WriteConstants(NumberTangents& numbers) const;
  /// Whether a level of friction follows such numbers.
  bool Reads(Number::Kind kind) const;
  /// Adds what signals change of inputs and forces of actuators.
  void AddSignals(Group group, NumberTangents& numbers) const;
  /// Adds what forces follow: those beside rows, else all others.
  void AddForces(NumberTangents& numbers, bool rows) const;
  void AddLevels(NumberTangents& numbers) const;
  void AddNext(NumberTangents& numbers) const;

 private:
  struct Instance {
    int id;
    Group group;
    bool row;
    int parameter;  ///< the first of its own among all
    LawSlopes slopes;
  };
  void Apply(const Instance& instance, const std::vector<Slope>& slopes,
             NumberTangents& numbers) const;

  std::vector<int> state_;           ///< [instance of the model] the first of its own
  std::vector<Instance> instances_;  ///< signals in the order they act
  bool uses_actuators_ = false;
  Tangents parameters_, spring_rest_, tendon_rest_, tendon_stiffness_, tendon_damping_;
};

}  // namespace continuum
