#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/tdcr/explained.h"
#include "models/tdcr/hybrid_fit.h"
#include "models/tdcr/measured.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// The linear correction (32): (u_1, u_n) = those of the model + W^T features, without intercept.
/// The paper has it for the Euler arc spline; of other models the curvatures of all arcs get what
/// is linear between the two.
struct Hybrid {
  Method method = Method::kEas;
  std::vector<std::string> features;  ///< among FeatureNames
  Eigen::MatrixXd weights;            ///< p x 6: kappa_x_1, kappa_y_1, tau_1, kappa_x_n, ..
  double penalty = 0;                 ///< on the weights, see FitWeights
  TipErrors tips;                     ///< of the corrected model
  Explained explained;                ///< of the cases for training, by the corrected model
  std::optional<LeftOut> left_out;    ///< of the same cases by trainings without them (five folds)

  /// Whether it explains nothing of the cases that it was trained on, or of those left out, or
  /// there are too few to leave some out.
  bool poor() const;
  /// One sentence for the user about both.
  std::string Sentence() const;
};

/// tau_1, tau_1^2, tau_n, tau_n^2, fx, fy, fz, T1..Tm.
std::vector<std::string> FeatureNames(int tendons);

/// Weights that minimise (30) over measured disks of the cases for training, plus a penalty on the
/// weights (FitWeights): 0 is the paper's training; nothing: the one that cross-validation over
/// these cases prefers. A feature that is constant over them is left out.
/// @throws Error (input) when there are fewer residuals than weights; (job) without convergence or
/// when a case has no equilibrium.
Hybrid Train(const Robot& robot, Method method, const std::vector<Pair>& pairs,
             const std::string& file, std::optional<double> penalty);

/// The `hybrid` map of a robot's file. @throws Error with file, line and key.
Hybrid ReadHybrid(const Yaml& file, const Robot& robot);

/// Corrects a solution by the hybrid's method in place: u, disks and line.
void Apply(const Hybrid& hybrid, const Robot& robot, const Loads& loads, Solution& solution);

}  // namespace continuum::tdcr
