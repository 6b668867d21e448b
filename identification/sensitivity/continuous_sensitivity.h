#pragma once

#include <memory>
#include <vector>

#include <Eigen/Cholesky>

#include "identification/sensitivity/continuous_dynamics.h"
#include "identification/sensitivity/force_derivatives.h"
#include "identification/sensitivity/sensor_derivatives.h"

namespace continuum {

/// A flow next to its present state, in closed form (Tangent), and that of neighbours, which are
/// the same machine with one parameter moved: with s = ∂y/∂p times this move,
///
///   ṡ = ∂f/∂y s + f' − f,   f' of the neighbour at the same y                     (1)
///
/// The matrices are those of the last y and serve all neighbours.
class ContinuousSensitivity {
 public:
  using Matrix = Eigen::MatrixXd;

  /// move: what the moves of the neighbours are to be divided by, so that s is of the size of y.
  ContinuousSensitivity(ContinuousDynamics& flow,
                        const std::vector<std::unique_ptr<ContinuousDynamics>>& neighbours,
                        double move);

  /// Whether a neighbour differs by what the closed form knows.
  bool Covers(std::size_t k) const { return covered_[k]; }
  /// At the time t of the log and y; what was made there is kept.
  void At(double t, const double* y);
  /// ṡ of every neighbour that is covered.
  void Rates(const std::vector<double*>& s, const std::vector<double*>& rates);
  /// Inputs have changed.
  void Forget() { y_.clear(); }
  /// Lets recorders of the covered neighbours see the row that is held, where the flow has just
  /// been observed.
  void Observe(const std::vector<const double*>& s, const std::vector<Recorder*>& recorders);

 private:
  ContinuousDynamics& flow_;
  const std::vector<std::unique_ptr<ContinuousDynamics>>& neighbours_;
  double move_;
  std::vector<bool> covered_;
  std::vector<std::size_t> columns_;          ///< neighbours that are covered
  std::vector<ModelDifference> differences_;  ///< of these
  ForceDerivatives tangent_;
  std::unique_ptr<SensorTangent> sensors_;
  double t_ = 0;
  std::vector<double> y_, rate_;
  Matrix inertia_, follow_, driven_;  ///< M; M⁻¹ ∂F/∂(q, q̇, w); M⁻¹ (F' − F)
  Matrix lag_;                        ///< [activations, 1 + covered] by itself, ẇ' − ẇ
  Eigen::LLT<Matrix> factor_;         ///< of M
  Matrix in_, out_;
};

}  // namespace continuum
