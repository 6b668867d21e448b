#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// Cosine and sine of the angle of a pressure line in the sense of phi [-].
using LineAngle = std::array<double, 2>;

/// So many lines at even angles, the first at 0. Those of three are exact thirds of a turn.
std::vector<LineAngle> EvenLines(int count);

/// One module: a hollow cylinder (radii r_1, r_2) with pressure lines of n_c braided tubes.
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
  std::vector<LineAngle> lines = EvenLines(3);

  double Area() const;          ///< section of the undeformed body without its bores [m^2]
  double SecondMoment() const;  ///< pi/4 (r_2^4 - r_1^4) [m^4]
};

/// Modules in series, from base to tip: each stands on the mount of the one before it. Their
/// pressures are numbered through.
struct ModuleSeries {
  std::vector<Module> modules;

  ModuleSeries(Module module) : modules{std::move(module)} {}  // NOLINT: one module is a series
  explicit ModuleSeries(std::vector<Module> all) : modules(std::move(all)) {}

  std::size_t size() const { return modules.size(); }
  const Module& operator[](std::size_t i) const { return modules[i]; }
  const Module& first() const { return modules.front(); }
  const Module& last() const { return modules.back(); }

  Eigen::Index lines() const;  ///< of all modules
  double length() const;       ///< of the soft parts [m]
  double mounts() const;       ///< length of all mounts [m]
  double mass() const;         ///< of modules and mounts [kg]
  double unit() const;         ///< E J_0 of the first module over length(): of moments [N m]
  /// Those of a module among the pressures of all.
  Eigen::VectorXd PressuresOf(std::size_t module, const Eigen::VectorXd& all) const;
  /// What acts on the base side of the upper end of a module's soft part: its mount, all modules
  /// above and `force` at the end of the last mount [N].
  Eigen::Vector3d Above(std::size_t module, const Eigen::Vector3d& force,
                        const Eigen::Vector3d& gravity) const;
  /// Dead force times its lever along the mount of a module: l_fs (loads beyond it + m_fs g/2).
  Eigen::Vector3d Lever(std::size_t module, const Eigen::Vector3d& force,
                        const Eigen::Vector3d& gravity) const;
};

struct Robot {
  ModuleSeries series;
  Eigen::Vector3d gravity;         ///< in the base frame [m/s^2]
  std::vector<std::string> names;  ///< of the modules in series
  std::string name;                ///< these joined by +

  /// The only module, or the first one.
  const Module& module() const { return series.modules.front(); }
  Module& module() { return series.modules.front(); }

  /// module: its name, or empty for what the file chooses by `module` or `series`.
  /// @throws Error (file:line: key) for a missing or unknown key or a value out of range.
  static Robot Read(const std::filesystem::path& file, const std::string& module = {});
  /// @throws Error for modules in series: `what` is of one module.
  void RequireOne(const std::string& what) const;
};

}  // namespace continuum::stiff_flop
