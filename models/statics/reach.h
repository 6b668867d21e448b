#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sim/io/csv.h"
#include "sim/numerics/solver.h"

namespace continuum::statics {

/// Where disks of a case should be, and what its drives may do.
struct Target {
  std::string name;             ///< of the case
  std::vector<int> coordinate;  ///< which are given: 3 i + 0, 1, 2 for x, y, z of disk i, from 0
  Eigen::VectorXd values;       ///< theirs, base frame [m]
  double low = 0, high = std::numeric_limits<double>::infinity();  ///< limits of every drive

  /// Root mean square over the disks of the distances of these coordinates [m].
  double Miss(const Eigen::VectorXd& coordinates) const;
};

/// Reads TARGETS.csv: `case`, any of `x, y, z` of the tip and of `x_i, y_i, z_i` of disks 1..disks
/// (empty: any value will do) [m], optional `low`, `high`: limits of every tension [N] or pressure
/// [Pa]; `least`: the lowest `low`, as cables do not push.
/// @throws Error with file, line and column for bad input.
std::vector<Target> ReadTargets(const CsvTable& table, int disks, double least = 0);

/// The target of every case, by name. @throws Error for a case that has none or two, and for a
/// target of no case; `file` is that of the targets.
std::vector<Target> TargetsOf(const std::vector<Target>& targets,
                              const std::vector<std::string>& cases, const std::string& file);

/// Where a robot stands under its drives.
struct Stand {
  Eigen::VectorXd points;  ///< the target's coordinates [m]
  Eigen::MatrixXd slopes;  ///< their derivatives by the drives
};

/// Solves the case under drives and may fail; what it last solved need not be the answer.
using StandUnder = std::function<std::optional<Stand>(const Eigen::VectorXd& drives)>;

/// Drives that lead somewhere.
struct Reached {
  /// ok: within 1e-6 of the robot's length. kOutOfDomain: out of reach, by the tangent no drives
  /// within the limits come nearer by a hundredth. kNoConvergence: the search ended elsewhere.
  numerics::Outcome outcome;
  Eigen::VectorXd drives;
  double miss = std::numeric_limits<double>::infinity();  ///< Target::Miss [m]

  bool out_of_reach() const { return outcome.status == numerics::Status::kOutOfDomain; }
};

/// What to say of a target with a disk farther from the base than the arm that holds it is long:
/// most(i) [m] of disk i, from 0. Nothing where all are near enough.
std::optional<Reached> TooFar(const Target& target, const std::function<double(int)>& most);

/// The drives w with the least sum of squares that bring the target's coordinates to their values:
///
///   min |w|^2   with   p(w) = p*,  low <= w <= high                                           (1)
///
/// By Gauss-Newton: p is replaced by its tangent at w, and (1) by the minimum of
/// |w|^2 + |p - p*|^2/1e-10 (w over `unit`, p over `length`), which reaches p* to 1e-10 where that
/// is possible, and comes nearest where it is not. Steps that move the disks by more than a fifth
/// of the length or the drives by more than `unit`, or that come no nearer, are made shorter. Where
/// contacts turn, the least change of w is tried beside the least w. Where `start` does not lead to
/// the target, the search begins again without drives.
Reached Reach(const StandUnder& stand, const Eigen::VectorXd& start, const Target& target,
              double unit, double length);

}  // namespace continuum::statics
