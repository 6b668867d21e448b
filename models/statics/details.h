#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "models/statics/results.h"

namespace continuum::statics {

/// What is written of a solved case beside its tip and its own columns, whatever the robot.
struct Details {
  Eigen::Quaterniond tip = Eigen::Quaterniond::Identity();  ///< frame of the tip, base frame
  Eigen::Vector3d force = Eigen::Vector3d::Zero();          ///< of all dead loads on the base [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< about the base's origin [N m], base frame
  double strain = 0;                                 ///< of the most strained fibre
  double energy = 0;  ///< 0 of the straight robot [J]; NaN where there is none
  /// Of every cable's path from base to end, slack or not, without stretch [m]. Empty: no cables.
  Eigen::VectorXd length = {};
  Eigen::VectorXd pull = {};        ///< tensions at the base that were not given [N]
  std::optional<double> miss = {};  ///< distance from a target [m]
};

/// Adds a dead force [N] at p; its work from where it acts on the straight robot lowers the energy.
void AddDead(const Eigen::Vector3d& force, const Eigen::Vector3d& p,
             const Eigen::Vector3d& straight, Details& details);

/// Which columns there are.
struct DetailColumns {
  int cables = 0;
  bool by_length = false;  ///< they are driven by length, their tensions are unknown
  bool reaches = false;    ///< what drives them is unknown: both, and `miss`
  bool list = false;       ///< of equilibria

  /// `qw..qz`, `Fx..Mz`, `strain_max`, then `l_1..` or `T_1..`, or both and `miss`, then
  /// `equilibrium`, `energy`. Whoever reaches by lengths adds these as `L1..`, as they are given.
  std::vector<std::string> Names() const;
};

/// equilibrium: its number in the list of its case, from 1; 0: there is no list.
void Set(const Details& details, int equilibrium, Results& results);

/// `prefix1`, `prefix2`, ..
void SetEach(const std::string& prefix, const Eigen::VectorXd& values, Results& results);

/// Of the two quaternions of a frame the one with w >= 0, in `qw..qz`.
std::vector<std::string> FrameColumns();
void SetFrame(Eigen::Quaterniond frame, Results& results);

}  // namespace continuum::statics
