#pragma once

#include <optional>

#include <Eigen/Core>

#include "models/statics/rising_load.h"
#include "models/twin_pivot/load.h"
#include "models/twin_pivot/robot.h"
#include "sim/numerics/solver.h"

/// Kinetostatics of the twin-pivot cable robot: discs joined by pairs of short Ni-Ti rods that bend
/// by turns about two crossed axes, pulled by four cables per section with dry friction in every
/// disc.
///
/// Base frame {O_0} at the centre of the fixed disc: X along the straight robot, Y up. SI units.
/// Source: Yang, Yang, Sun, Chen, "Comprehensive kinetostatic modeling and morphology
/// characterization of cable-driven continuum robots for in-situ aero-engine maintenance",
/// Frontiers of Mechanical Engineering 18(3), 40, 2023.
namespace continuum::twin_pivot {

/// beta_m [rad] and what follows from them. When the outcome is not ok, beta is the last root found
/// on the way, the residual is |f| there, and the rest is empty.
struct Solution {
  numerics::Outcome outcome;
  Eigen::VectorXd beta;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< O_n [m]
  Eigen::MatrixXd tension;  ///< F_mj in every joint, joints x cables [N], 0 beyond the anchor
  Eigen::MatrixXd length;   ///< l_mj, joints x cables [m], 0 beyond the anchor
  Eigen::VectorXd pull;     ///< F_SC of cables driven by length [N]
  Eigen::MatrixXd slide;    ///< s of every contact, row m at disc m; 0 without friction
  /// The state that the contacts slid from last, as in Load: its own, or that of the last part of
  /// the way. A load that describes this solution has to have it.
  Eigen::MatrixXd reference, reference_slide;
  int parts = 1;  ///< of the way, more than 1 where contacts turned back on it
  statics::Stability stability;
};

/// The angles at which every joint is in balance, |f|_2 <= 1e-10 N m, on the shape that the rising
/// load reaches from straight (statics::FollowRisingLoad); never a saddle.
///
/// Loads far below buckling leave one equilibrium: Newton from `start` (straight when not given)
/// without friction, then with contacts that turn within 1 mm, then within robot.eps; a stage that
/// fails follows the path of roots from the one before (loads from 0, friction from 0, width from
/// 1 mm). Other loads, and where this ends at a saddle, are followed from 0. Where load.length is
/// given, it and the dead loads are, and the tensions are unknown (statics::LengthDriven).
///
/// Far below buckling contacts slide as their whole way says, (15)-(16). Above, the loads grow in
/// 50 parts, and contacts go on from part to part: those that turn back on the way resist there.
/// Where they grow evenly 4 or 8 parts do, to 2e-4 of the length.
/// @throws Error when the coefficient of friction is negative at an angle of the solution, or of
/// the last root found when the friction then could not be followed.
Solution Solve(const Robot& robot, const Load& load, Method method = Method::kVirtualWork,
               const std::optional<Eigen::VectorXd>& start = std::nullopt);

/// The same from the state `before` that `earlier` has led to: loads go from those to these, and
/// contacts begin as they were left. load.reference and load.slide are not used.
Solution SolveFrom(const Robot& robot, const Load& earlier, const Solution& before, Load load,
                   Method method = Method::kVirtualWork);

/// The equilibrium next to beta, stable or not: `outcome` is that of the solver. beta is a root
/// with contacts that turn within `width` [m].
Solution SolveNear(const Robot& robot, const Load& load, Method method, const Eigen::VectorXd& beta,
                   double width);

/// f [N m] at given angles, for tests and comparisons. Empty when the angles are out of the domain
/// (a joint bent by pi or more, or a contact that would lock: s w >= 1).
std::optional<Eigen::VectorXd> Residual(const Robot& robot, const Load& load, Method method,
                                        const Eigen::VectorXd& beta);
/// df/dbeta [N m/rad] by dual numbers.
std::optional<Eigen::MatrixXd> ResidualSlope(const Robot& robot, const Load& load, Method method,
                                             const Eigen::VectorXd& beta);

}  // namespace continuum::twin_pivot
