#pragma once

#include <string>
#include <vector>

#include "models/statics/error_table.h"
#include "models/statics/fit_spread.h"
#include "models/statics/measured_points.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// E and gamma, or one of them, from measured tips.
struct Calibration {
  Robot robot;                     ///< calibrated
  std::vector<std::string> names;  ///< among E, gamma
  Eigen::VectorXd x;               ///< E over that of the start; gamma [rad]
  statics::FitSpread spread;       ///< of x
  std::vector<std::string> at_bound;
  int cases = 0;        ///< used for fitting
  double rmse = 0;      ///< of their tips [m]
  double scatter = 0;   ///< of the measured tips about their mean [m]
  double within = 0;    ///< distance of a tip that the fit has not seen, with `level` [m]
  double level = 0.95;  ///< of `within` (statics::WithinOf)

  /// A model that leaves half of the scatter has explained nothing.
  bool poor() const { return rmse > 0.5 * scatter; }
};

/// Minimises sum |x - rho(l)|^2 over measured tips of the cases for training, by the forward model:
/// Levenberg-Marquardt from the robot's values, E within a factor 100, gamma from pi/4 to pi/2.
/// `file` names the measured tips. @throws Error (input) for other names, too few tips or tips that
/// do not depend on a parameter; (job) where a case has no equilibrium or the fit does not
/// converge.
Calibration Calibrate(const Robot& robot, const Method& method,
                      const std::vector<std::string>& names, const std::vector<Case>& cases,
                      const std::vector<statics::MeasuredPoints>& measured,
                      const std::string& file);

}  // namespace continuum::stiff_flop
