#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numbers>
#include <vector>

namespace continuum::tdcr {

inline constexpr int kMaxTendons = 64;

/// A part of the rod with one cross-section, a rod or a tube, and the disks on it. SI units.
struct Section {
  double diameter = 0;         ///< of the outside [m]
  double bore = 0;             ///< diameter of the inside of a tube [m]
  double EI = 0, GJ = 0;       ///< [N m^2]
  double E = 0;                ///< of the material [Pa]; 0: EI and GJ are given
  double mass_per_length = 0;  ///< of the rod [kg/m]
  double disk_mass = 0;        ///< of one disk [kg]
  double disk_radius = 0;      ///< tendons run within it; 0: not given [m]
  /// Curvature when nothing acts (kappa_x, kappa_y, tau) [1/m].
  Eigen::Vector3d natural = Eigen::Vector3d::Zero();
  /// Places of the disks from where the section begins [m]; the last one is its end.
  std::vector<double> disks;

  double length() const { return disks.back(); }
  double area() const {  ///< of the cross-section [m^2]
    return std::numbers::pi / 4 * (diameter * diameter - bore * bore);
  }
  /// EI, or where the rod twists more easily than one of a material, 3/2 GJ [N m^2].
  double Softest() const { return std::min(EI, 1.5 * GJ); }
};

/// Where a tendon passes the disks: 0 is the base, the last one holds its end. Between disks radius
/// and angle grow linearly with s.
struct Route {
  std::vector<double> radius;  ///< from the rod's axis [m]
  std::vector<double> angle;   ///< about +z from +x, of the section's frame [rad]

  int end() const { return static_cast<int>(radius.size()) - 1; }
};

}  // namespace continuum::tdcr
