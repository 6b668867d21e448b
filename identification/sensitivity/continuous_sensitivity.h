#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "identification/sensitivity/continuous_dynamics.h"
#include "identification/sensitivity/force_derivatives.h"
#include "identification/sensitivity/sensor_derivatives.h"

namespace continuum {

/// Derivatives of the continuous dynamics in closed form (ForceDerivatives). A perturbed model is
/// the same machine with one parameter moved by a little; with s = ∂y/∂p times this move,
///
///   ṡ = ∂f/∂y s + f' − f,   f' of the perturbed model at the same y               (1)
///
/// The matrices are those of the last y and serve all perturbed models.
class ContinuousSensitivity {
 public:
  using Matrix = Eigen::MatrixXd;

  /// move: what the moves of the perturbed models are to be divided by, so that s is of the size of
  /// y.
  ContinuousSensitivity(ContinuousDynamics& dynamics,
                        const std::vector<std::unique_ptr<ContinuousDynamics>>& perturbed,
                        double move);

  /// Whether a perturbed model differs by what the closed form knows.
  bool Covers(std::size_t k) const { return why_not_[k].empty(); }
  /// Why it does not ("body_pos differs").
  const std::string& WhyNot(std::size_t k) const { return why_not_[k]; }
  /// At the time t of the log and y; what was made there is kept.
  void At(double t, const double* y);
  /// ṡ of every perturbed model that is covered.
  void Rates(const std::vector<double*>& s, const std::vector<double*>& rates);
  /// Inputs have changed.
  void Forget() { y_.clear(); }
  /// Whether Observe lets recorders see a covered perturbed model; else it has to be observed
  /// itself, as its sensors have no closed form.
  bool Observes(std::size_t k) const { return Covers(k) && sensors_; }
  /// Lets recorders of the covered perturbed models see the row that is held, where the dynamics
  /// have just been observed.
  void Observe(const std::vector<const double*>& s, const std::vector<Recorder*>& recorders);

 private:
  ContinuousDynamics& dynamics_;
  const std::vector<std::unique_ptr<ContinuousDynamics>>& perturbed_;
  double move_;
  std::vector<std::string> why_not_;          ///< [perturbed model]
  std::vector<std::size_t> columns_;          ///< perturbed models that are covered
  std::vector<ModelDifference> differences_;  ///< of these
  ForceDerivatives derivatives_;
  std::unique_ptr<SensorDerivatives> sensors_;  ///< null: of outputs without closed form
  double t_ = 0;
  std::vector<double> y_, rate_;
  Matrix inertia_, follow_, driven_;  ///< M; M⁻¹ ∂F/∂(q, q̇, w); M⁻¹ (F' − F)
  Matrix lag_;                        ///< [activations, 1 + covered] by itself, ẇ' − ẇ
  Eigen::LLT<Matrix> factor_;         ///< of M
  Matrix in_, out_;
};

}  // namespace continuum
