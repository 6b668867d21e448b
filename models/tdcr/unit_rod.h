#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "models/tdcr/channel.h"
#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// The rod between two disks, in units of the whole length L and of the first section's EI. Where
/// disks are far apart, or the rod between them is soft, it is cut into equal parts: an arc each.
struct RodArc {
  double per_rod;                      ///< L over its length
  double before;                       ///< arcs of its length between the base and where it begins
  Eigen::Vector3d stiffness, natural;  ///< K, u_0
  /// Whether u is another one just after the disk where it begins: the stiffness or u_0 changes,
  /// or a tendon ends or turns there.
  bool jump;
  int disk = 0;             ///< the next one towards the tip, 1..n
  int part = 0, parts = 1;  ///< which of how many between disks

  bool ends_at_disk() const { return part + 1 == parts; }
  double start() const { return before / per_rod; }
  double length() const { return 1 / per_rod; }
};

/// Rod and channels of a robot when nothing acts.
struct RodShape {
  /// cut: arcs that are long or soft among the others. Otherwise every arc ends at a disk.
  explicit RodShape(const Robot& robot, bool cut = true);

  const Channel& At(std::size_t tendon, std::size_t arc) const {
    return channels[tendon * arcs.size() + arc];
  }
  /// Length of a tendon in a part [from, to] of an arc, by Simpson's rule.
  double RestLength(std::size_t tendon, std::size_t arc, double from, double to) const;
  /// Of a whole tendon.
  double RestLength(std::size_t tendon) const;

  /// Arcs between the base and a disk.
  std::size_t ArcsTo(int disk) const { return arcs_to[static_cast<std::size_t>(disk)]; }

  std::vector<RodArc> arcs;
  std::vector<std::size_t> arcs_to{0};  ///< of disks 0 (the base) to n
  std::vector<std::size_t> ends;        ///< of every tendon: arcs that it runs through
  std::vector<Channel> channels;        ///< tendons x arcs
};

/// Arcs of the whole rod.
int CountArcs(const Robot& robot);

/// Lengths of a robot's tendons between base and end when nothing acts [m].
Eigen::VectorXd RestLengths(const Robot& robot);

/// A rod and what acts on it, in units of its length L and of EI/L. s from the base (0) to the tip
/// (1).
struct UnitRod {
  /// friction: of tendons in their holes, where the loads have any. Slack tendons do nothing and
  /// are left out unless `all` are asked for.
  UnitRod(const Robot& robot, const Loads& loads, bool friction, bool all = false);

  /// The loads of `to` times `share` and those of `from` times the rest; both have the tendons of
  /// this one.
  void Mix(const UnitRod& from, const UnitRod& to, double share);
  /// Where one of two has moments, so has the other then.
  void ShareMoments(UnitRod& other);
  /// No load at all.
  UnitRod Unloaded() const;

  int arcs() const { return static_cast<int>(shape->arcs.size()); }
  const RodArc& Arc(int arc) const { return shape->arcs[static_cast<std::size_t>(arc)]; }
  int ArcAt(double s) const;
  /// Of the tendons below.
  bool Runs(std::size_t k, int arc) const {
    return static_cast<std::size_t>(arc) < shape->ends[static_cast<std::size_t>(tendon[k])];
  }
  const Channel& ChannelOf(std::size_t k, int arc) const {
    return shape->At(static_cast<std::size_t>(tendon[k]), static_cast<std::size_t>(arc));
  }
  /// Dead force on a section, of all that acts beyond it.
  Eigen::Vector3d Force(int arc, double s) const {
    return beyond.col(arc) + (1 - s) * weight.col(arc);
  }
  bool has_moments() const { return moment.cols() > 0; }
  bool Jumps(int arc) const { return arc > 0 && (Arc(arc).jump || has_moments()); }
  /// Dead moment at the disk where an arc ends.
  Eigen::Vector3d MomentAfter(int arc) const {
    return has_moments() ? Eigen::Vector3d(moment.col(arc)) : Eigen::Vector3d::Zero();
  }

  std::shared_ptr<const RodShape> shape;
  double mu;
  bool friction;
  std::vector<int> tendon;   ///< which of the robot's, of the vectors below
  std::vector<double> pull;  ///< at the base, times L^2/EI, as the forces below
  std::vector<int> direction;
  /// Of every arc: the force on it is beyond + (1 - s) weight.
  Eigen::Matrix3Xd beyond, weight;
  Eigen::Matrix3Xd moment;  ///< at the disks where arcs end; empty: none

 private:
  void SetForces(const Robot& robot, const Loads& loads);
};

}  // namespace continuum::tdcr
