#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "models/stiff_flop/case.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {

/// The quasi-static part of NoLoad.mat, from 7 s on.
struct Log {
  std::vector<double> time;               ///< [s]
  std::vector<Eigen::Vector3d> pressure;  ///< gauge, in the order of the module's lines [Pa]
  std::vector<Eigen::Vector3d> marker;    ///< in the tracker's frame [m]

  /// Every `stride`-th row. Pressures are counted from their mean of the first 7 s, during which
  /// all valves are shut; lines 2 and 3 of the log are numbered against the sense of phi.
  /// @throws Error when the file has another layout.
  static Log Read(const std::filesystem::path& file, int stride);
  Log First(std::size_t rows) const;
};

/// Where the tracker sees the module: marker = position + turn (rho(l) + Tilt offset), where Tilt
/// turns y straight into the tip's tangent. A marker is glued where there is room, not on the axis.
struct Registration {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of the marker from the tip [m]

  Eigen::Vector3d Marker(const Solution& solution) const {
    return position + turn * Carried(solution, offset);
  }
  /// A point that moves with the tip, in the base frame [m].
  static Eigen::Vector3d Carried(const Solution& solution, const Eigen::Vector3d& offset);

  /// Least squares over the rows [0, rows): turn and position in closed form, offset by
  /// Gauss-Newton on what they leave. The rows must bend to several sides.
  static Registration Fit(const std::vector<Solution>& shapes, const Log& log, std::size_t rows);
};

/// Train: cycles 1 and 2 of each chamber (until 37.8 s); validate: cycle 3.
std::size_t TrainRows(const Log& log);

/// Root mean square and mean distance [m] of markers over rows [first, last).
struct TipError {
  double rms = 0, mean = 0;
};
TipError ErrorOf(const Registration& registration, const std::vector<Solution>& shapes,
                 const Log& log, std::size_t first, std::size_t last);

/// The forward model at every row. @throws Error when a row has no equilibrium.
std::vector<Solution> Replay(const Robot& robot, const Method& method, const Log& log);

/// Marker residuals [mm], three a row, of the forward model after the best registration; false when
/// a row has no equilibrium.
bool MarkerResiduals(const Robot& robot, const Method& method, const Log& log, double* f);

/// E [Pa] and gamma [rad] of least squared marker distance over the train rows, registration fitted
/// for each. Starts from the robot's own and changes them.
numerics::Outcome FitBraid(const Method& method, const Log& log, Robot& robot);

}  // namespace continuum::stiff_flop
