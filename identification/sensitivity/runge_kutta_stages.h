#pragma once

#include <array>
#include <vector>

#include "sim/model/model_spec.h"

namespace continuum {

/// The four stages of a step of MuJoCo's RK4, evaluated once more beside the simulation:
///
///   x_i = x_0 + h α_i ẋ_{i−1},   α = (0, 1/2, 1/2, 1)                            (1)
///   x⁺ = x_0 + h Σ β_i ẋ_i,      β = (1, 2, 2, 1)/6                              (2)
///
/// x are positions, speeds and activations. Every effect acts in all four stages, with its states
/// as they were where the step began. They advance once, after (2), by what the last stage gave and
/// by where the step ended.
class RungeKuttaStages {
 public:
  static constexpr std::array<double, 4> kReach{0, 0.5, 0.5, 1};                       ///< α
  static constexpr std::array<double, 4> kWeight{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};  ///< β

  /// machine: whose steps these are.
  explicit RungeKuttaStages(const ModelAndData& machine);

  /// Before a step: where it starts.
  void Keep(const mjModel& m, const mjData& d);
  /// After it, for i from 0 to 3 in this order: stage i, as a step that began there would leave its
  /// forces, with the controls that actuators meet.
  mjData& Evaluate(const mjModel& m, std::size_t i);

 private:
  Owned<mjData> data_;
  std::vector<double> start_;
};

}  // namespace continuum
