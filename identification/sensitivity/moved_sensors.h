#pragma once

#include <vector>

#include <Eigen/Dense>

#include "identification/sensitivity/number_tangents.h"
#include "sim/model/mujoco_handles.h"
#include "sim/simulation/output_recorder.h"

namespace continuum {

/// What sensors without a derivative of their own (accelerometers, gyros, forces) show where a
/// perturbed model is, beside the machine:
///
///   y(x + ε s, p + δ),   s = ∂x/∂p,   x = (q, v, w, z)                              (1)
///
/// by a forward pass of the perturbed model, at a state that differs by what the tangents say. Less
/// what the machine shows it is ε dy/dp, accelerations and forces included.
///
/// The engine's solver begins that pass at the machine's accelerations, so it ends nearer to the
/// solution than the machine did, by 1e-8 of its cost. Where it has rows, what such a pass shows of
/// the machine itself takes the place of y(x, p): both end equally near.
class MovedSensors {
 public:
  MovedSensors(const mjModel& m, double move) : move_(move), again_(mj_makeData(&m)) {}
  /// The next column's model.
  void Add(const ModelAndData& perturbed) { models_.push_back(&perturbed); }

  /// Begins a row; d: of the machine, at the row's state.
  void At(const mjModel& m, const mjData& d);
  /// Lets a recorder see (1) of a column at this row.
  void Observe(const mjModel& m, const NumberTangents& numbers, const Tangents& activation,
               Eigen::Index column, std::size_t row, Recorder& recorder);

 private:
  double move_;
  std::vector<const ModelAndData*> models_;
  std::vector<double> state_;  ///< of the row
  Owned<mjData> again_;        ///< of the machine, its forward pass made once more
  Eigen::VectorXd shift_;      ///< what the machine shows less what it shows then
};

}  // namespace continuum
