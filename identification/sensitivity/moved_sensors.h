#pragma once

#include <vector>

#include "identification/sensitivity/number_tangents.h"
#include "sim/simulation/output_recorder.h"

namespace continuum {

/// What sensors without a derivative of their own (accelerometers, gyros, forces) show where a
/// perturbed model is, beside the machine:
///
///   y(x + ε s, p + δ),   s = ∂x/∂p,   x = (q, v, w, z)                              (1)
///
/// by a forward pass of the perturbed model, at a state that differs by what the tangents say. Less
/// what the machine shows it is ε dy/dp, accelerations and forces included.
class MovedSensors {
 public:
  explicit MovedSensors(double move) : move_(move) {}
  /// The next column's model.
  void Add(const ModelAndData& perturbed) { models_.push_back(&perturbed); }

  /// Lets a recorder see (1) of a column at a row; d: of the machine, at the row's state.
  void Observe(const mjModel& m, const mjData& d, const NumberTangents& numbers,
               const Tangents& activation, Eigen::Index column, std::size_t row,
               Recorder& recorder);

 private:
  double move_;
  std::vector<const ModelAndData*> models_;
  std::vector<double> state_;
};

}  // namespace continuum
