#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/tdcr/explained.h"
#include "models/tdcr/measured.h"

namespace continuum::tdcr {

/// One modelled case with its measured disks.
struct Sample {
  Eigen::Matrix3Xd u;        ///< of the uncorrected model's arcs [1/m]
  Eigen::Matrix3Xd beside;   ///< its disks less those of arcs with u [m]; 0 for eas and pcca
  Eigen::VectorXd features;  ///< those that are used
  Eigen::Matrix3Xd points;   ///< base frame; NaN: not measured
  const Pair* pair;
};
using Samples = std::vector<const Sample*>;

/// Residuals of (30): coordinates of the measured disks.
Eigen::Index Residuals(const Samples& samples);

/// Curvatures of the arcs with the correction W^T features of the first and the last arc, linear
/// between, and the disks that belong to them.
Eigen::Matrix3Xd Corrected(const Robot& robot, const Eigen::MatrixXd& weights,
                           const Sample& sample);
Eigen::Matrix3Xd Disks(const Robot& robot, const Eigen::Matrix3Xd& u, const Sample& sample);

/// What a training found, and whether it came to its end.
struct Weights {
  Eigen::MatrixXd values;
  bool converged = false;
};

/// Weights W (p x 6) that minimise the mean over the samples of sum_i |x_i - O_i|^2/L^2, plus
/// penalty |V|^2, where V_jc = L W_jc max|feature j| is what feature j bends or twists the rod by
/// where it is largest [rad]: without it, forces and twists that the samples hardly tell apart get
/// large weights of opposite signs, which another load does not cancel. Penalty 0 is (30) alone.
/// Levenberg-Marquardt from zero weights; where it does not converge, those that it reached.
Weights FitWeights(const Robot& robot, const Samples& samples, double penalty);

/// What weights do to samples that they have not seen, each sample once, by five folds.
struct LeftOut {
  Explained explained;
  std::vector<double> tips;  ///< tip errors [% of L]
  bool converged = true;     ///< all five trainings
};
/// Nothing with a single sample, and when a fold has fewer residuals than weights and no penalty.
std::optional<LeftOut> CrossValidate(const Robot& robot, const Samples& samples, double penalty);

/// The penalty among 0 and 1e-6 .. 10 that explains most of the cases left out; 0 when none can be
/// validated.
double ChoosePenalty(const Robot& robot, const Samples& samples);

}  // namespace continuum::tdcr
