#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "models/twin_pivot/per_section.h"

namespace continuum::twin_pivot {

/// mu(theta) = a theta^2 + b theta + c; theta [rad] between cable and the disc's normal.
struct Friction {
  double a = 0;  ///< [1/rad^2]
  double b = 0;  ///< [1/rad]
  double c = 0;  ///< [1]

  double At(double theta) const { return (a * theta + b) * theta + c; }
  double Slope(double theta) const { return 2 * a * theta + b; }
};

/// Between the centres of discs m-1 and m.
struct Link {
  double L = 0;       ///< length of the rod [m]
  double before = 0;  ///< half the thickness of disc m-1 [m]
  double after = 0;   ///< half the thickness of disc m [m]
};

struct Robot {
  std::string file;         ///< where it was read, for messages
  std::vector<int> discs;   ///< moving discs per section, even
  std::vector<int> cables;  ///< per section: those that end in its last disc
  PerSection L;             ///< length of a rod [m]
  PerSection h;             ///< thickness of a disc [m]; the fixed disc is of the first section
  PerSection E;             ///< [Pa]
  PerSection I_z;           ///< of one rod [m^4]
  PerSection rods = 2;      ///< rods per joint
  std::vector<double> r;    ///< radius of each cable's holes [m], section by section
  std::vector<double> phi;  ///< their angle from Y toward Z [rad]
  PerSection m_D;           ///< one disc [kg]
  PerSection m_NiTi;        ///< the rods of one joint [kg]
  PerSection rho_cable;     ///< of the cables that end in the section [kg/m]
  PerSection m_CL;          ///< one of their locking devices [kg]
  double cable_EA = 0;      ///< of a cable [N]; 0: it does not stretch
  double strain_limit = 0;  ///< most strain that the rods bear; 0: not given
  Friction friction;        ///< variable coefficient
  double mu_const = 0;      ///< constant coefficient of condition III
  double theta_max = 0;     ///< largest angle that a, b, c are measured at [rad]; 0: not given
  double eps = 0;  ///< change of cable length over which a contact turns from stick to slip [m]
  Eigen::Vector3d gravity = {0, -9.81, 0};  ///< in the base frame [m/s^2]

  int Joints() const;  ///< n, as many as moving discs
  int Cables() const { return static_cast<int>(r.size()); }
  int Sections() const { return static_cast<int>(discs.size()); }
  int SectionOfJoint(int joint) const;  ///< joint from 0; disc m is that of joint m-1
  int SectionOfCable(int cable) const;  ///< where it ends
  /// The disc (counted from 1) that holds the end of a cable: the last one of its section.
  int Anchor(int cable) const;
  std::vector<Link> Links() const;
  double Place(int disc) const;  ///< O_disc from O_0, straight [m]
  double Length() const { return Place(Joints()); }
  double Thickness(int disc) const;         ///< of disc 0..n [m]
  double LengthOfCable(int cable) const;    ///< between the discs' faces, straight [m]
  double Stiffness(int section = 0) const;  ///< of one joint [N m/rad]
  double RodDiameter(int section) const;    ///< of a round rod with this I_z [m]

  /// @throws Error (file:line: key) for a missing or unknown key or a value out of range.
  static Robot Read(const std::filesystem::path& file);
};

}  // namespace continuum::twin_pivot
