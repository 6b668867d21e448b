#pragma once

#include <span>
#include <vector>

#include "identification/sensitivity/model_difference.h"
#include "identification/sensitivity/number_tangents.h"

namespace continuum {

/// Forces of actuators that effects read or change, to first order, from the control as the
/// actuator meets it to its range. In this order: inputs change (signals), SetInputs, forces change
/// (signals), Limit.
class ActuatorDerivatives {
 public:
  ActuatorDerivatives(const ModelAndData& machine, std::span<const ModelAndData* const> perturbed,
                      double move);
  /// Writes the tangents that no step changes: gains, biases, gears, ranges.
  void WriteConstants(NumberTangents& numbers) const;

  /// Takes up the controls where a step begins.
  void Begin(const mjModel& m, const mjData& d, NumberTangents& numbers);
  /// Values [nactuator] for signals to change: kInput, then kActuator.
  std::vector<double>& input() { return input_; }
  std::vector<double>& force() { return force_; }
  const std::vector<double>& control() const { return control_; }

  /// Forces and their tangents by the inputs, which d has for controls from now on, before signals;
  /// false: an input is beyond its control's range.
  bool SetInputs(const mjModel& m, mjData& d, const Tangents& activation, NumberTangents& numbers);
  /// Their ranges.
  void Limit(const mjModel& m, NumberTangents& numbers);
  void PutControlsBack(mjData& d) const;

  /// force [nv] += factor gear df along joints and tendons, less what a method's own view of the
  /// actuator's speed gives already, for actuators marked by a number in given.
  void AddForces(const mjModel& m, const mjData& d, std::span<const double> given, double factor,
                 const NumberTangents& numbers, Tangents& force) const;

 private:
  Eigen::RowVectorXd RateTangent(const mjModel& m, int a, const NumberTangents& numbers) const;
  double Rate(const mjModel& m, const mjData& d, int a) const;

  std::vector<const ModelAndData*> perturbed_;
  double move_;
  std::vector<double> control_, input_, force_, was_;
  Tangents gain_, bias_, gear_, range_;
};

}  // namespace continuum
