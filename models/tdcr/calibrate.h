#pragma once

#include <string>
#include <vector>

#include "models/tdcr/explained.h"
#include "models/tdcr/measured.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// The parameters (31) that (30) gives, with their standard errors from the residuals' scatter.
struct Calibration {
  Robot robot;  ///< with E, mu and base_rotation replaced
  Eigen::VectorXd
      standard;  ///< errors of E, theta_x, theta_y, theta_z (and mu); NaN: not determined
  std::vector<std::string> at_bound;
  int cases = 0;  ///< used for fitting
  TipErrors tips;
  Explained explained;  ///< of the cases for fitting
};

/// Minimises sum |R^c x_i - O_i|^2 over E, base_rotation and, unless the method is crt, mu; over
/// the measured disks of the cases for training. Levenberg-Marquardt from the robot's values, and
/// again from the rotation that best lays the measured points on the modelled ones.
///
/// Bounds: E within a factor 100 of the robot's, 0 <= mu <= 0.999, angles within pi.
/// @throws Error (input, naming the file of the shapes) when there are fewer coordinates than
/// unknowns; (job) when a case has no equilibrium or the fit does not converge.
Calibration Calibrate(const Robot& robot, Method method, const std::vector<Pair>& pairs,
                      const std::string& file);

}  // namespace continuum::tdcr
