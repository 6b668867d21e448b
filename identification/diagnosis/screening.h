#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/diagnosis/criteria.h"
#include "identification/fit/fit.h"

namespace continuum {

/// The residual of a fitted model, whitened, to first order free of whatever may vary: what the
/// data say against the model.
///
///   z = M r,   M = I − A A⁺
///
/// r: whitened residuals over the train logs; A: the sensitivities of the fitted parameters and,
/// with priors and within limits, what the time step adds. r is extrapolated to a step of zero; the
/// prior is as wide as that is uncertain.
class ProjectedResidual {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// residuals, jacobian: [log] at the optimum; fixed: parameters that a bound holds; step: [log]
  /// Problem::StepEffects, which may be there in part, or no columns where the step does not
  /// matter.
  ProjectedResidual(const Whitening& whitening, const std::vector<bool>& use,
                    const std::vector<Vector>& residuals, const std::vector<Matrix>& jacobian,
                    const std::vector<bool>& fixed, const std::vector<Matrix>& step,
                    const Criteria& criteria = {});

  /// z: the rows of the train logs, then one for each prior.
  const Vector& vector() const { return residual_; }
  /// |z|², the whitened sum of squares at the optimum to first order.
  double cost() const { return residual_.squaredNorm(); }
  /// The logs that it is made of.
  const std::vector<bool>& use() const { return use_; }
  /// By how much the parameters change to get there, those that are fixed by nothing.
  const Vector& shift() const { return shift_; }
  /// M applied to columns given per log.
  Matrix Project(const std::vector<Matrix>& columns) const;
  /// How much of |z|² may be expected from noise of size 1: measured numbers less free parameters.
  double freedom() const { return freedom_; }
  /// Standard deviation of what a step of zero gives, in units of what the time step adds.
  double roughness() const { return roughness_; }

 private:
  Matrix Out(Matrix columns) const;

  const Whitening* whitening_;
  std::vector<bool> use_;
  Matrix basis_;  // orthonormal, of A
  Vector shift_;
  Vector residual_;
  double freedom_;
  double roughness_ = 0;
};

/// Orthonormal columns that span A's, directions below 1e-9 of the largest left out.
Eigen::MatrixXd Basis(const Eigen::MatrixXd& A);

/// Directions in which one candidate could move the residuals.
struct Probe {
  Eigen::MatrixXd columns;   ///< projected, per unit of the coefficients
  std::vector<double> sign;  ///< of each coefficient: +1 may only be positive, −1 negative, 0 both
  std::vector<double> share = {};  ///< the coefficients at which it was probed
  std::size_t start = 0;           ///< of its hypothesis' starts
  Eigen::MatrixXd whole = {};      ///< the columns at coefficients of 1, where those are others
  std::vector<bool> on_top = {};   ///< coefficients that do nothing without the others

  /// Where all candidates can be compared: at the sizes of their starts.
  const Eigen::MatrixXd& AtStart() const { return whole.size() > 0 ? whole : columns; }
};

/// The part of |z|² that a probe explains with coefficients of allowed signs, and those.
struct Explained {
  double amount = 0;
  Eigen::VectorXd coefficients;
};
Explained ExplainedBy(const Probe& probe, const Eigen::VectorXd& z);
/// The same with only one coefficient, where that explains nearly as much (PlainestOf).
Explained PlainlyExplainedBy(const Probe& probe, const Eigen::VectorXd& z);

/// What several candidates explain, each with one or more probes (the best counts), and their
/// family-wise significance: the share of draws of white noise in which some candidate does as
/// well, by what noise lets it explain, as this one did with z. Repeats exactly for a seed. draws:
/// of the noise where it is not white, one column each, instead.
struct Significance {
  std::vector<double> explained;  ///< [candidate] of its best probe
  std::vector<std::size_t> best;  ///< [candidate] its best probe
  std::vector<double> p;          ///< [candidate] family-wise; 1 where the noise is not known
};
/// Without significance, as the noise is not known.
Significance BestOfProbes(const std::vector<std::vector<Probe>>& candidates,
                          const Eigen::VectorXd& z);
Significance SignificanceOf(const std::vector<std::vector<Probe>>& candidates,
                            const Eigen::VectorXd& z, std::uint64_t seed,
                            const Eigen::MatrixXd& draws = {});

}  // namespace continuum
