#pragma once

#include <vector>

#include "identification/sensitivity/number_tangents.h"

namespace continuum {

/// What parameters change of a step, by one step of a perturbed model from the very state of the
/// machine: with x⁺ = Φ(x, p),
///
///   ∂Φ/∂p = (Φ(x, p + δ) − Φ(x, p − δ)) / 2ε                                         (1)
///
/// for any parameter that leaves a model its structure: geometry above all. No state drifts away
/// from the machine's, so that δ can be small. The difference is one-sided beside a bound of p, and
/// where no row of the constraint solver acts: what bends within less than 1 mm is stiff rows.
class SingleSteps {
 public:
  explicit SingleSteps(double move) : move_(move) {}

  /// column: of the tangents; mirrored: the model at p − δ, null: p is at a bound.
  void Add(const ModelAndData& perturbed, const ModelAndData* mirrored, Eigen::Index column) {
    models_.push_back({&perturbed, mirrored, column});
  }
  bool empty() const { return models_.empty(); }

  /// Before the machine's step: keeps where it starts.
  void Keep(const mjModel& m, const mjData& d);
  /// After it: takes the same step with the perturbed models.
  void Take(const mjModel& m, const mjData& d);
  /// Adds (1) to tangents of states where a step ends: positions, speeds, activations, states of
  /// effects.
  void AddTo(NumberTangents& numbers, Tangents& activation) const;

  /// Poses of a perturbed model's bodies and sites where the machine is; null: of a column that is
  /// none of these.
  const mjData* Pose(const mjModel& m, const mjData& d, Eigen::Index column);

 private:
  struct Model {
    const ModelAndData *machine, *mirrored;
    Eigen::Index column;
    Eigen::VectorXd q = {}, v = {}, w = {}, z = {};
  };
  void Step(const ModelAndData& machine, double h) const;

  double move_;
  std::vector<Model> models_;
  std::vector<double> start_;
};

}  // namespace continuum
