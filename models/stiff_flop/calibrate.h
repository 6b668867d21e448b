#pragma once

#include <string>
#include <vector>

#include "models/statics/error_table.h"
#include "models/statics/fit_spread.h"
#include "models/statics/measured_points.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// E and gamma from measured tips, or upper ends of modules in series.
struct Calibration {
  Robot robot;                     ///< calibrated
  std::vector<std::string> names;  ///< as asked for
  Eigen::VectorXd x;               ///< E over that of the start; gamma [rad]
  statics::FitSpread spread;       ///< of x
  std::vector<std::string> at_bound;
  int cases = 0;        ///< used for fitting
  double rmse = 0;      ///< of their measured ends [m]
  double scatter = 0;   ///< of the measured ends of each module about their mean [m]
  double within = 0;    ///< distance of an end that the fit has not seen, with `level` [m]
  double level = 0.95;  ///< of `within` (statics::WithinOf)

  /// A model that leaves half of the scatter has explained nothing.
  bool poor() const { return rmse > 0.5 * scatter; }
};

/// The modules that a parameter is of: all for E and gamma, those of a name for E_NAME, gamma_NAME;
/// none where there is no such parameter.
std::vector<std::size_t> ModulesOf(const Robot& robot, const std::string& name);
bool IsGamma(const std::string& name);

/// Minimises sum |x - rho(l)|^2 over measured ends of the cases for training, by the forward model:
/// Levenberg-Marquardt from the robot's values, E within a factor 100, gamma from pi/4 to pi/2.
/// `file` names the measured tips. @throws Error (input) for other names, too few tips or tips that
/// do not depend on a parameter; (job) where a case has no equilibrium or the fit does not
/// converge.
Calibration Calibrate(const Robot& robot, const Method& method,
                      const std::vector<std::string>& names, const std::vector<Case>& cases,
                      const std::vector<statics::MeasuredPoints>& measured,
                      const std::string& file);

}  // namespace continuum::stiff_flop
