#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace continuum::stiff_flop {

/// How the wall of a braided chamber deforms; numbers of equations are those of the paper.
enum class ChamberLaw {
  kFixed,       ///< (16): the radius stays
  kElongation,  ///< (12, 14): the thread's length under uniform stretch
  kExact,       ///< (25-28): a stiff thread that twists, lead angle varies around the section
  kConstant     ///< (29): a soft thread that keeps its lead angle
};

/// How the body's section deforms.
enum class BodyLaw {
  kFixed,       ///< (11): not at all, Hooke's law
  kElongation,  ///< (34): uniform contraction
  kSimple,      ///< (35): every fibre contracts by its own stretch
  kPlanar,      ///< (39-42): shift in the bending plane only
  kGeneral      ///< (44-47): shift, and width as of each fibre
};

enum class Direction { kInverse, kForward };

/// One of the eight pairs of Table 2.
struct Method {
  BodyLaw body = BodyLaw::kGeneral;
  ChamberLaw chamber = ChamberLaw::kConstant;

  /// `energy+body+chamber` as the user writes it; empty: the default of the direction.
  /// @throws Error that lists the valid names.
  static Method Parse(const std::string& name, Direction direction);
  /// All eight, in the order of Table 2.
  static const std::array<Method, 8>& All();
  std::string Name(Direction direction) const;
};

/// One module: a hollow cylinder (radii r_1, r_2) with three pressure lines of n_c braided tubes.
struct Module {
  double r_c1 = 0;   ///< inner radius of a tube [m]
  double r_c2 = 0;   ///< outer radius of a tube [m]
  double gamma = 0;  ///< lead angle of the thread from the tube's axis [rad]; pi/2 = rings
  double r_o = 0;    ///< distance of a tube from the module's axis [m]
  double r_1 = 0;    ///< inner radius of the body [m]
  double r_2 = 0;    ///< outer radius of the body [m]
  double l = 0;      ///< length [m]
  double l_fs = 0;   ///< length of the mount beyond the tip [m]
  double E = 0;      ///< Young's modulus [Pa], incompressible: G = E/3
  double m = 0;      ///< mass of the module, spread over l [kg]
  double m_fs = 0;   ///< mass of the mount, at l_fs/2 [kg]
  int n_c = 1;       ///< tubes per pressure line

  double Area() const;          ///< section of the undeformed body without its bores [m^2]
  double SecondMoment() const;  ///< pi/4 (r_2^4 - r_1^4) [m^4]
};

struct Robot {
  Module module;
  Eigen::Vector3d gravity;  ///< in the base frame [m/s^2]
  std::string name;         ///< of the module that is solved

  /// module: its name, or empty for the one that the file chooses.
  /// @throws Error (file:line: key) for a missing or unknown key or a value out of range.
  static Robot Read(const std::filesystem::path& file, const std::string& module = {});
};

/// Angles of the three pressure lines in the sense of phi: cos and sin [-].
inline constexpr double kHalfRoot3 = 0.86602540378443864676;
inline constexpr std::array<std::array<double, 2>, 3> kLine = {
    {{1, 0}, {-0.5, kHalfRoot3}, {-0.5, -kHalfRoot3}}};

}  // namespace continuum::stiff_flop
