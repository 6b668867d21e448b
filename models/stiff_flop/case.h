#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/statics/rising_load.h"
#include "models/stiff_flop/even.h"
#include "models/stiff_flop/module.h"
#include "sim/io/csv.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {

struct Load {
  Eigen::Vector3d force;    ///< at the end of the mount, base frame [N]
  Eigen::Vector3d gravity;  ///< base frame [m/s^2]
};

/// One row of CASES.csv.
struct Case {
  std::string label;
  Eigen::VectorXd given;  ///< inverse: kappa [1/m], phi [rad], lambda_l; forward: p1.. [Pa]
  Load load;
};

struct Cases {
  Direction direction = Direction::kInverse;
  std::vector<Case> rows;

  /// The columns decide the direction. @throws Error (file:line, column) for wrong columns, a cell
  /// that is no number, kappa < 0 or lambda_l <= 0, shapes of modules in series.
  static Cases Read(const CsvTable& table, const Robot& robot);
};

enum class Status { kOk, kOutOfDomain, kNoEquilibrium, kNotConverged };
std::string Name(Status status);

/// The deformed section at the base.
struct BaseSection {
  double r_o = 0;                    ///< distance of the tubes from the axis [m]
  std::vector<double> r_G = {};      ///< of every line: radius of the circle of the gas area [m]
  std::vector<double> gamma_e = {};  ///< of every line: lead angle after the elongation [rad]
  double x_in = 0, x_out = 0;  ///< body's extent toward and away from the centre of bending [m]
};

/// Answer to a case; meaningful as far as `status` is kOk.
struct Solution {
  Status status = Status::kNotConverged;
  numerics::Outcome outcome = {};
  statics::Stability stability = {};                 ///< of the forward model
  Eigen::VectorXd answer = Eigen::Vector3d::Zero();  ///< inverse: p; forward: kappa, phi, lambda_l
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();     ///< rho(l) [m]
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitY();  ///< d_2(l)
  BaseSection section = {};                            ///< of the first module
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();    ///< of the forward model: M(0) [unit()]
  std::vector<Axis<double>> bases = {};  ///< of the forward model: lower end of every module
  Eigen::VectorXd by_gamma = Eigen::Vector3d::Zero();  ///< inverse: dp, forward: d tip by gamma
  Eigen::VectorXd by_E = Eigen::Vector3d::Zero();      ///< the same by E
};

}  // namespace continuum::stiff_flop
