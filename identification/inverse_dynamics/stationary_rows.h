#pragma once

#include <vector>

#include <mujoco/mujoco.h>
#include <Eigen/Core>

#include "sim/model/joint_equalities.h"

namespace continuum {

/// Standard deviation of the speed [per s] that noise of a measured position leaves after a
/// low-pass of cutoff c [share of the sampling rate], of white noise σ with the rows' period h:
///
///   σ_v = σ 2π/h √(2 c³/3),   σ² = mean (y − F y)² / (1 − 2c)
double SpeedNoise(const std::vector<double>& y, const std::vector<double>& filtered, double cutoff,
                  double h);

/// Where dry friction holds, its force is any up to its level, and the inverse model knows only the
/// level: such rows say nothing of it. After mj_inverse: marks the free joints whose equation
/// contains friction at a speed that noise may have made. v, noise: of the free joints.
void MarkStationary(const JointEqualities& ties, const mjModel& m, const mjData& d,
                    const std::vector<double>& v, const std::vector<double>& noise,
                    Eigen::Ref<Eigen::RowVectorXd> stationary);

/// Those marks [row, free joint] that last longer than a low-pass of this cutoff remembers (a joint
/// that only reverses passes through), with the rows that the low-pass mixes with them.
Eigen::MatrixXd WidenedByFilter(const Eigen::MatrixXd& stationary, double cutoff);

}  // namespace continuum
