#pragma once

#include <functional>
#include <vector>

#include "models/spa/response.h"

namespace continuum {

/// Soft actuators on end: each stands on the tip of the one before, and all are alike.
///
/// Newton-Euler over the segments. Outwards, the tip of a segment moves the base of the next one:
///
///   ω' = Rᵀ ω + W δ̇,   ω̇' = Rᵀ ω̇ + W δ̈ + Ẇ δ̇ − (W δ̇) × Rᵀ ω                                   (1)
///   v' = Rᵀ (v + ω × p + J δ̇),   a' = Rᵀ (a + ω̇ × p + ω × (ω × p + 2 J δ̇) + J δ̈ + J̇ δ̇)       (2)
///
/// with tip p, R, its Jacobian J and turning W (PccTip). Inwards, the wrench (f', τ') that a base
/// needs loads the tip before it: δ gets Jᵀ R f' + Wᵀ τ', the base (R f', R τ' + p × R f').
/// Vectors of all segments have three numbers each, base to tip.
class SpaSeries {
 public:
  SpaSeries(const Spa<double>& segment, int segments);

  const Spa<double>& segment() const { return segment_; }
  int segments() const { return segments_; }

  /// What all bases are doing: one more than there are segments, the last being the tip.
  std::vector<SpaBase<double>> Bases(const Eigen::VectorXd& delta, const Eigen::VectorXd& rate,
                                     const Eigen::VectorXd& acceleration,
                                     const SpaBase<double>& base) const;
  /// Generalised forces [N] that this motion needs, without pressure; wrench: of the mount [N, N
  /// m].
  Eigen::VectorXd InverseDynamics(const Eigen::VectorXd& delta, const Eigen::VectorXd& rate,
                                  const Eigen::VectorXd& acceleration, const SpaBase<double>& base,
                                  Eigen::Matrix<double, 6, 1>* wrench = nullptr) const;
  /// Generalised forces [N] of the pressures [Pa] in all chambers.
  Eigen::VectorXd Actuation(const Eigen::VectorXd& delta, const Eigen::VectorXd& pressure) const;
  /// δ̈ [m/s²].
  Eigen::VectorXd Acceleration(const Eigen::VectorXd& delta, const Eigen::VectorXd& rate,
                               const SpaBase<double>& base, const Eigen::VectorXd& pressure) const;
  SpaEnergy<double> Energy(const Eigen::VectorXd& delta, const Eigen::VectorXd& rate,
                           const SpaBase<double>& base) const;

 private:
  Spa<double> segment_;
  int segments_;
};

/// δ [m] at rest under constant pressures [Pa] with the base at rest, reached as these and the
/// weight rise together. Throws Error::Job when the path ends before (a fold), or at an equilibrium
/// that is not stable.
Eigen::VectorXd SpaSeriesEquilibrium(const SpaSeries& series, const Eigen::VectorXd& pressure,
                                     const SpaBase<double>& base);

/// One instant of a response; the wrench of the mount in axes of the first base, the tip in them.
struct SpaSeriesSample {
  double time;
  Eigen::VectorXd delta, rate;
  Eigen::Matrix<double, 6, 1> wrench;
  Eigen::Vector3d tip;
};

/// SpaRespond for actuators on end, from rest at δ = 0 with empty chambers: input[k] holds the line
/// pressures [Pa] of all chambers from k·period to (k + 1)·period.
std::vector<SpaSeriesSample> SpaSeriesRespond(const SpaSeries& series,
                                              const std::vector<Eigen::VectorXd>& input,
                                              double period, const SpaBaseMotion& base,
                                              double tolerance = 1e-10);

}  // namespace continuum
