#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/statics/results.h"

namespace continuum::statics {

/// What a robot shows at given unknowns and inputs: its tip, its cables, its disks.
struct Shown {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();              ///< [m], base frame
  Eigen::Quaterniond frame = Eigen::Quaterniond::Identity();  ///< of the tip
  Eigen::VectorXd length;  ///< of every cable without tension, base to end [m]; may be empty
  Eigen::VectorXd points;  ///< x, y, z of one disk after the other [m]
};

/// How the tip of a solved case moves with small changes of its inputs.
struct TipResponse {
  std::vector<std::string> input;  ///< names: fx, fy, fz [N], then T1.. [N], L1.. [m] or p1.. [Pa]
  int loads = 3;                   ///< how many of them act on the tip; the others drive it
  /// A column for every input. Rows: d tip [m]; the turn of the tip's frame as a vector in the base
  /// frame [rad]; of every cable its length [m], or its tension [N] where lengths are inputs; and
  /// of every disk x, y, z [m].
  Eigen::MatrixXd slope;
};

/// A robot in equilibrium, for Respond. Unknowns z and inputs w are in units that bend it by about
/// 1.
class Responding {
 public:
  virtual ~Responding() = default;
  /// f(z, w), over a stiffness; false out of the domain.
  virtual bool Residual(const Eigen::VectorXd& z, const Eigen::VectorXd& w,
                        Eigen::VectorXd& f) const = 0;
  /// df/dz at w = 0.
  virtual bool Tangent(const Eigen::VectorXd& z, Eigen::MatrixXd& k) const = 0;
  virtual std::optional<Shown> Show(const Eigen::VectorXd& z, const Eigen::VectorXd& w) const = 0;
  /// By how much unknown i is moved to differentiate Show.
  virtual double Step(Eigen::Index /*unknown*/) const { return 1e-5; }
};

/// Derivatives of what is shown by the inputs, a row for each number, by the implicit function
/// theorem at a root z of f(z, 0):
///
///   dy/dw = y_w - y_z f_z^-1 f_w                                                              (1)
///
/// f_z is the tangent of the whole structure; the others are differences of evaluations, central or
/// from the side that is in the domain (no tension below zero): no case is solved. Contacts that
/// slide go on to slide and those that rest hold: against its direction a robot with friction is
/// stiffer. Nothing where the tangent is singular.
std::optional<Eigen::MatrixXd> Respond(const Responding& robot, const Eigen::VectorXd& z,
                                       Eigen::Index inputs);

/// The response of cables held by winches, from that of cables held by tensions. With l = l(F, T)
/// the lengths without tension, of taut cables alone:
///
///   dT = l_T^-1 (dL - l_F dF),   dy = y_F dF + y_T dT                                         (2)
///
/// Slack cables neither move the tip nor are tensioned. Nothing where lengths do not decide the
/// tensions.
std::optional<TipResponse> HoldLengths(const TipResponse& by_tension,
                                       const Eigen::VectorXd& tension);

/// Half axes of the ellipsoid that the tip reaches by all inputs of unit size together, columns by
/// falling length. `drives`: by what drives the robot, else by forces at the tip.
Eigen::Matrix3d Ellipsoid(const TipResponse& response, bool drives);

/// Responses of solved cases (--compliance), a row for every input of a case: `case`, `by` (fx, ..,
/// T1, ..), `x, y, z`, `rx, ry, rz`, and `l_1..` or `T_1..`, all per unit of the input. Then the
/// half axes of both ellipsoids: `force_1..3` and `drive_1..3`, in `x, y, z`.
class ComplianceTable {
 public:
  ComplianceTable(int cables, bool by_length);

  void Add(const std::string& name, const TipResponse& response);
  /// By extension, as Results.
  void Write(const std::filesystem::path& path) const { results_.Write(path); }

 private:
  void AddAxes(const std::string& name, const std::string& kind, const Eigen::Matrix3d& axes);

  int cables_;
  std::string cable_;  ///< l_ or T_
  Results results_;
};

}  // namespace continuum::statics
