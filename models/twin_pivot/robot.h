#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace continuum::twin_pivot {

/// mu(theta) = a theta^2 + b theta + c; theta [rad] between cable and the disc's normal.
struct Friction {
  double a = 0;  ///< [1/rad^2]
  double b = 0;  ///< [1/rad]
  double c = 0;  ///< [1]

  double At(double theta) const { return (a * theta + b) * theta + c; }
  double Slope(double theta) const { return 2 * a * theta + b; }
};

struct Robot {
  std::string file;         ///< where it was read, for messages
  std::vector<int> discs;   ///< moving discs per section, even
  double L = 0;             ///< length of a rod [m]
  double h = 0;             ///< thickness of a disc [m]
  double E = 0;             ///< [Pa]
  double I_z = 0;           ///< of one rod [m^4]
  double rods = 2;          ///< rods per joint
  std::vector<double> r;    ///< radius of each cable's holes [m], four per section
  std::vector<double> phi;  ///< their angle from Y toward Z [rad]
  double m_D = 0;           ///< one disc [kg]
  double m_NiTi = 0;        ///< the rods of one joint [kg]
  double rho_cable = 0;     ///< [kg/m]
  double m_CL = 0;          ///< one locking device [kg]
  double cable_EA = 0;      ///< of a cable [N]; 0: it does not stretch
  Friction friction;        ///< variable coefficient
  double mu_const = 0;      ///< constant coefficient of condition III
  double eps = 0;  ///< change of cable length over which a contact turns from stick to slip [m]
  Eigen::Vector3d gravity = {0, -9.81, 0};  ///< in the base frame [m/s^2]

  int Joints() const;  ///< n, as many as moving discs
  int Cables() const { return static_cast<int>(r.size()); }
  /// The disc (counted from 1) that holds the end of a cable: the last one of its section.
  int Anchor(int cable) const;
  double Stiffness() const { return rods * E * I_z / L; }  ///< of one joint [N m/rad]

  /// @throws Error (file:line: key) for a missing or unknown key or a value out of range.
  static Robot Read(const std::filesystem::path& file);
};

}  // namespace continuum::twin_pivot
