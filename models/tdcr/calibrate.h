#pragma once

#include <string>
#include <vector>

#include "models/statics/fit_spread.h"
#include "models/tdcr/explained.h"
#include "models/tdcr/measured.h"
#include "models/tdcr/model.h"
#include "models/tdcr/parameters.h"

namespace continuum::tdcr {

/// How near a prediction is to the robot: of shapes that the fit has not seen, `level` have disk i
/// within within[i] [m] of where the calibrated model puts it (statics::WithinOf). NaN: never
/// measured.
struct Prediction {
  double level = 0.95;
  int cases = 0;
  std::vector<double> within;
};

/// The parameters that (30) gives.
struct Calibration {
  Robot robot;                    ///< calibrated
  std::vector<Unknown> unknowns;  ///< what was fitted, at x
  Eigen::VectorXd x;
  statics::FitSpread spread;  ///< of x
  std::vector<std::string> at_bound;
  int cases = 0;  ///< used for fitting
  TipErrors tips;
  Explained explained;  ///< of the cases for fitting
  Prediction prediction;
};

/// Minimises sum |R^c x_i - O_i|^2 over the unknowns and the measured disks of the cases for
/// training. Levenberg-Marquardt from the robot's values, and again from the base rotation, if that
/// is unknown, that best lays the measured points on the modelled ones.
///
/// @throws Error (input, naming the file of the shapes) when there are fewer coordinates than
/// unknowns, or the shapes do not depend on one of them; (job) when a case has no equilibrium or
/// the fit does not converge.
Calibration Calibrate(const Robot& robot, Method method, const std::vector<Unknown>& unknowns,
                      const std::vector<Pair>& pairs, const std::string& file);
/// Of DefaultParameters.
Calibration Calibrate(const Robot& robot, Method method, const std::vector<Pair>& pairs,
                      const std::string& file);

}  // namespace continuum::tdcr
