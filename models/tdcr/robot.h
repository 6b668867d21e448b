#pragma once

#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "models/tdcr/section.h"
#include "sim/io/csv.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {

/// An elastic rod along z with n disks and m tendons. SI units.
///
/// Without `sections` it is the segment of the paper: one straight rod, disks at equal distances,
/// tendons at equal angles that run parallel to the rod to the tip, tendon 1 on +x. With them
/// `sections` and `routes` say what it is; of the scalars up to `disk_mass` then only `length`,
/// `disks`, `tendons` and, as sizes, `diameter` and `tendon_radius` (the largest ones) are set.
struct Robot {
  double length = 0.134;
  double diameter = 0.99e-3;
  int disks = 9;
  int tendons = 3;
  double tendon_radius = 7e-3;
  double E = 60e9;
  double nu = 0.3;
  double density = 0;
  double disk_mass = 0;
  double mu = 0;                                      ///< Coulomb friction between tendon and disk
  double tendon_EA = 0;                               ///< of a tendon [N]; 0: it does not stretch
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2], base frame
  /// Curvature of the rod when nothing acts (kappa_x, kappa_y, tau) [1/m]: only the Cosserat rod
  /// knows it.
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();
  /// sigma_k about +z from +x [rad] of the segment's tendons; empty: equal angles, tendon 1 on +x.
  std::vector<double> tendon_angles;
  Eigen::Vector3d base_rotation = Eigen::Vector3d::Zero();  ///< theta_x, theta_y, theta_z of (31)

  std::vector<Section> sections;
  std::vector<Route> routes;  ///< of the tendons; given with `sections`

  bool has_sections() const { return !sections.empty(); }
  /// The sections; without them the whole rod as one.
  std::vector<Section> Sections() const;
  /// The route of a tendon, given or parallel to the rod.
  Route RouteOf(int tendon) const;
  /// Distance of a disk from the base along the rod; 0 is the base [m].
  double Place(int disk) const;
  double mass() const;  ///< of the rod and all disks [kg]
  /// Stiffness of the softest section [N m^2].
  double Softest() const;

  double arc() const { return length / disks; }  ///< without sections
  double area() const { return std::numbers::pi * diameter * diameter / 4; }
  /// Of the first section.
  double EI() const {
    return has_sections() ? sections.front().EI : E * std::numbers::pi * std::pow(diameter, 4) / 64;
  }
  double GJ() const { return EI() / (1 + nu); }  ///< without sections: G = E/(2 (1 + nu)), J = 2 I
  /// Moments are divided by this in residuals.
  double moment() const { return EI() / length; }
  /// Tensions are divided by this: that of a tendon with this moment about the rod [N].
  double tension() const { return moment() / tendon_radius; }
  double AngleOf(int tendon) const;  ///< sigma_k, without sections
  /// Writes the equal angles into `tendon_angles` where that is empty.
  void SpreadTendons();
  Eigen::Vector2d Hole(int tendon) const;
  /// R^c = R_x R_y R_z of base_rotation: measuring frame to base frame.
  Eigen::Matrix3d MeasuringToBase() const;
};

/// The contacts of disks and tendons find their directions themselves (`auto` in the file).
inline constexpr int kAsItSlides = 2;

/// Change of a tendon's length over which a contact turns from rest to sliding [m].
inline constexpr double kGivesWay = 1e-6;

/// Where the contacts of each tendon k stand: a row for every disk (eas, pcca), or for every step
/// of the integrator along the rod (crt_friction).
struct Contacts {
  Eigen::MatrixXd length;  ///< of the tendon from disk i - 1 to disk i, or in step i [m]
  /// Share of its largest friction with which a contact resists, -1..1: 1 when the tendon was
  /// pulled through towards the base, -1 when it was released. That of disk i, 0 of the last disk,
  /// where tendons end; or that of step i, which follows what slides through the start of the step.
  Eigen::MatrixXd share;
};

/// Whether some contact neither slides on nor has turned: its share is between -1 and 1, and not 0
/// as where there is none.
bool SomeRest(const Contacts& contacts);

/// What acts on the robot in one case.
struct Loads {
  std::vector<double> tension;  ///< T_k at the base [N], at least 0
  std::vector<int> direction;   ///< 1 pulled, -1 released, 0 without friction, or kAsItSlides
  Eigen::Vector3d tip_force = Eigen::Vector3d::Zero();  ///< dead force at the tip, base frame [N]
  /// Dead forces [N] and moments [N m] at disks 1..n, base frame, 3 x n; empty: none. That at disk
  /// n adds to `tip_force`.
  Eigen::Matrix3Xd disk_force = {}, disk_moment = {};
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double mu = 0;
  bool own_mu = false;  ///< mu belongs to this case, whatever the robot's
  /// Of tendons that are driven by length: what is between base and tip without tension [m]; then
  /// `tension` is not read. Empty: driven by tension.
  Eigen::VectorXd length = {};
  /// Of tendons with kAsItSlides, the state that they slide from; empty: straight, nothing has
  /// slid.
  Contacts from = {};

  bool AsItSlides() const;

  /// The tensions, the forces, moments and weights multiplied by `load`.
  Loads Scaled(double load) const;
  /// All of the dead forces added as if they pulled in one direction at the tip, and moments as if
  /// forces at its end made them [N].
  double DeadForce(const Robot& robot) const;
};

struct Case {
  std::string name;
  Loads loads;
  int reference = -1;  ///< the row whose contacts this one goes on from; -1: the straight robot
};

/// Reads a robot's file. @throws Error with file, line and key for a value that is missing or out
/// of range.
Robot ReadRobot(const Yaml& file);

/// Reads CASES.csv. @throws Error with file, line and column for bad input.
std::vector<Case> ReadCases(const CsvTable& table, const Robot& robot);

/// Whether the table has these columns: all or none. @throws Error when some are missing.
bool HasVector(const CsvTable& table, const std::vector<std::string>& columns);

/// The loads of a robot at rest: no tension, no tip force, its own gravity and friction.
Loads NoLoads(const Robot& robot);

}  // namespace continuum::tdcr
