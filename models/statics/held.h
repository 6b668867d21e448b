#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "models/statics/results.h"

namespace continuum::statics {

/// What every solved case holds beside its tip, whatever the robot.
struct Hold {
  Eigen::Quaterniond tip = Eigen::Quaterniond::Identity();  ///< frame of the tip in the base frame
  Eigen::Vector3d force = Eigen::Vector3d::Zero();          ///< of all dead loads on the base [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< about the base's origin [N m], base frame
  double strain = 0;                                 ///< of the most strained fibre
};

/// `qw..qz`, `Fx..Mz` and `strain_max`.
std::vector<std::string> HoldColumns();
void Set(const Hold& hold, Results& results);

/// `equilibrium` and `energy`, of lists of equilibria.
std::vector<std::string> EquilibriumColumns();

/// ok, or saddle of an unstable equilibrium in a list of them.
std::string StatusOf(const numerics::Outcome& outcome, const Stability& stability);

/// Places along the axes of solved cases (--shape): `case`, `s` [m], `disk` (empty between disks),
/// `x, y, z`, `qw..qz`, and the tension of every cable from there on, T_1..T_m [N].
class ShapeTable {
 public:
  explicit ShapeTable(int cables);

  struct Place {
    double s;
    int disk;  ///< -1: none
    Eigen::Vector3d point;
    Eigen::Quaterniond frame;
    Eigen::VectorXd tension;
  };
  void Add(const std::string& name, const Place& place);
  /// By extension, as Results.
  void Write(const std::filesystem::path& path) const { results_.Write(path); }

 private:
  Results results_;
};

}  // namespace continuum::statics
