#pragma once

#include <span>
#include <string>
#include <vector>

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

  /// Those of the step that has been taken. d: after it, with the positions and speeds before it;
  /// state: of the plugins before it [npluginstate].
  void Update(const mjModel& m, const mjData& d, const double* state, const double* qpos_after,
              const double* qvel_after);
  /// Adds to pull [ntendon] what the laws pull along tendons.
  void AddPulls(std::span<double> pull) const;

  Eigen::Index parameters() const { return parameters_.rows(); }
  /// Writes the tangents that no step changes: parameters, rests of springs.
  void WriteConstants(NumberTangents& numbers) const;
  /// Whether a level of friction follows such numbers.
  bool Reads(Number::Kind kind) const;
  /// Adds what forces follow: those beside rows, else all others.
  void AddForces(NumberTangents& numbers, bool rows) const;
  void AddLevels(NumberTangents& numbers) const;
  void AddNext(NumberTangents& numbers) const;

 private:
  struct Instance {
    int id;
    bool row = false;
    int parameter;  ///< the first of its own among all
    LawSlopes slopes;
  };
  void Apply(const Instance& instance, const std::vector<Slope>& slopes,
             NumberTangents& numbers) const;

  std::vector<int> state_;  ///< [instance of the model] the first of its own
  std::vector<Instance> instances_;
  Tangents parameters_, spring_rest_, tendon_rest_;
};

}  // namespace continuum
