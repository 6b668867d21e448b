#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/statics/rising_load.h"
#include "models/tdcr/line.h"
#include "models/tdcr/robot.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {

/// The static models of one segment. `kCrtFriction` is beyond the paper: the Cosserat rod whose
/// tendons also rub along their channels; it makes synthetic measurements.
enum class Method { kEas, kPcca, kCrt, kCrtFriction };

/// @throws Error for another name than eas, pcca, crt, crt_friction.
Method ParseMethod(const std::string& name);
std::string NameOf(Method method);

/// Throws Error where eas or pcca, which know one section and parallel tendons, are asked for
/// another robot, or for loads at disks.
void RequireTaken(const Robot& robot, const Loads& loads, Method method,
                  const std::string& where = "--method");

struct Solution {
  numerics::Outcome outcome;
  statics::Stability stability;
  Eigen::VectorXd x;       ///< the unknowns of the method, for a warm start
  Eigen::Matrix3Xd u;      ///< kappa_x, kappa_y, tau of arcs 1..n [1/m]
  Eigen::Matrix3Xd disks;  ///< O_1..O_n [m], base frame
  Contacts contacts;       ///< eas, pcca and, of contacts that remember, crt_friction
  /// What those with kAsItSlides slid from last: where the path began, or where contacts turned
  /// back on it. Loads that describe this solution have it as `from`.
  Contacts from;
  Line line;             ///< crt and crt_friction
  Eigen::VectorXd pull;  ///< T_k at the base of tendons driven by length [N]
};

/// The equilibrium that is reached by raising all loads together from zero.
///
/// Without `start`: from the rod at rest. Dead forces below 2.4 EI/L^2 leave one
/// equilibrium and damped Newton finds it; above, the path of equilibria is followed from zero
/// load, and where it ends the shape falls to the next stable one (statics::FollowRisingLoad). With
/// `start` (x of a neighbouring case): Newton from there, and as above when that fails or ends at a
/// saddle. Where loads.length is given, it and the dead loads grow from the straight robot, and the
/// tensions are unknown (statics::LengthDriven). u and disks are only valid when outcome.ok(); then
/// the shape is stable.
Solution SolveCase(const Robot& robot, const Loads& loads, Method method,
                   const Eigen::VectorXd* start = nullptr);

/// The same by loads that grow from those of `earlier` to `loads`; contacts with kAsItSlides begin
/// as they stand in `before`, the solution of `earlier` by the same method (loads.from is not
/// read):
///
///   s = SlideFrom(s_before, (l_before - l)/eps),  eps = 1 um                                  (1)
///
/// l: length of the tendon beyond the contact. Friction takes s times its largest share, (13). A
/// contact that turns back gives way within eps; held loads move nothing, and a pull in parts is
/// the pull in one. crt knows no friction: it solves the case alone.
Solution SolveFrom(const Robot& robot, const Loads& earlier, const Solution& before, Loads loads,
                   Method method);

/// The equilibrium next to x, stable or not: `outcome` is that of Newton's method. Contacts with
/// kAsItSlides have slid from loads.from.
Solution SolveNear(const Robot& robot, const Loads& loads, Method method, const Eigen::VectorXd& x);

}  // namespace continuum::tdcr
