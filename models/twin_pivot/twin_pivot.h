#pragma once

#include <Eigen/Dense>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/statics/newton.h"

/// Kinetostatics of the twin-pivot cable robot: discs joined by pairs of short Ni-Ti rods that bend
/// by turns about two crossed axes, pulled by four cables per section that rub in every disc.
///
/// Base frame {O_0} at the centre of the fixed disc: X along the straight robot, Y up. SI units.
/// Source: Yang, Yang, Sun, Chen, "Comprehensive kinetostatic modeling and morphology
/// characterization of cable-driven continuum robots for in-situ aero-engine maintenance",
/// Frontiers of Mechanical Engineering 18(3), 40, 2023.
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

/// What the model counts (Tab 5): I no friction; II friction mu(theta); III friction mu_const; IV
/// friction mu(theta) but weights of discs only; V all, and the payload.
enum class Condition { kI, kII, kIII, kIV, kV };
constexpr std::array<const char*, 5> kConditions = {"I", "II", "III", "IV", "V"};

/// kVirtualWork: the balance that follows from virtual work, exact for the bent rods. kPrinted:
/// moments about the centre of the proximal disc as in (36), (40), for comparison only.
enum class Method { kVirtualWork, kPrinted };

struct Load {
  Condition condition = Condition::kV;
  std::vector<double> tension;                       ///< F_SC of every cable at the base [N]
  double payload = 0;                                ///< [kg] at O_n; counts in V only
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< at O_n, in the base frame [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< in the base frame [N m]
  Eigen::Vector3d gravity = {0, -9.81, 0};           ///< in the base frame [m/s^2]
  /// l_ref [m], joints x cables: the state from which the cables started to slide; empty: straight.
  Eigen::MatrixXd reference;
};

/// beta_m [rad] and what follows from them. When the outcome is not ok, beta is the last root found
/// on the way, the residual is |f| there, and the rest is empty.
struct Solution {
  statics::Outcome outcome;
  Eigen::VectorXd beta;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< O_n [m]
  Eigen::MatrixXd tension;  ///< F_mj in every joint, joints x cables [N], 0 beyond the anchor
  Eigen::MatrixXd length;   ///< l_mj, joints x cables [m], 0 beyond the anchor
};

/// The angles at which every joint is in balance, |f|_2 <= 1e-10 N m.
///
/// Newton from `start` (straight when not given) without friction, then with contacts that turn
/// within 1 mm, then within robot.eps; a stage that fails follows the path of roots from the one
/// before (loads from 0, friction from 0, width from 1 mm).
/// @throws Error when the coefficient of friction is negative at an angle of the solution, or of
/// the last root found when the friction then could not be followed.
Solution Solve(const Robot& robot, const Load& load, Method method = Method::kVirtualWork,
               const std::optional<Eigen::VectorXd>& start = std::nullopt);

/// f [N m] at given angles, for tests and comparisons. Empty when the angles are out of the domain
/// (a joint bent by pi or more, or a contact that would lock: s w >= 1).
std::optional<Eigen::VectorXd> Residual(const Robot& robot, const Load& load, Method method,
                                        const Eigen::VectorXd& beta);
/// df/dbeta [N m/rad] by dual numbers.
std::optional<Eigen::MatrixXd> ResidualSlope(const Robot& robot, const Load& load, Method method,
                                             const Eigen::VectorXd& beta);

/// Cable lengths l_mj [m], joints x cables, 0 beyond the anchor.
Eigen::MatrixXd CableLengths(const Robot& robot, const Eigen::VectorXd& beta);

/// Points of the centre line in the base frame [m]: O_0, then for each joint `per_rod` points along
/// the rod (its two ends included) and O_m.
std::vector<Eigen::Vector3d> CentreLine(const Robot& robot, const Eigen::VectorXd& beta,
                                        int per_rod = 6);

}  // namespace continuum::twin_pivot
