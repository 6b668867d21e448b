#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// What calibration can change of a robot.
enum class Quantity {
  kE,             ///< E (or EI), GJ with it
  kGJ,            ///< GJ alone; of a material that is nu
  kDensity,       ///< of the rod, or its mass per length
  kDiskMass,      ///< of every disk of a section
  kPrecurvature,  ///< kappa_x, kappa_y, tau at rest
  kAngle,         ///< of a tendon, along its whole route
  kRadius,        ///< of a tendon, in one ratio along its whole route
  kMu,            ///< friction between tendons and disks
  kBaseRotation   ///< theta_x, theta_y, theta_z of (31)
};

/// One number x that calibration changes, from the nominal robot's value: a ratio that begins at 1,
/// or a sum: curvature times L, angles [rad], friction.
struct Unknown {
  Quantity quantity;
  int part = 0;       ///< of sections or tendons, from 0
  int component = 0;  ///< of a vector
  std::string name;   ///< as the user wrote it, such as E, E_2 or angle_3

  bool is_ratio() const;
};

/// The names that a robot knows, for messages.
std::vector<std::string> ParameterNames(const Robot& robot, Method method);

/// E, base_rotation and, unless the method is crt, mu; of a robot with sections the E of each.
std::vector<std::string> DefaultParameters(const Robot& robot, Method method);

/// The unknowns of names such as `E` (of every section, each its own), `E_2` (of one) and
/// `base_rotation` (three numbers), each once. `where` names the list in messages. @throws Error
/// for a name that the robot lacks, and for a mass of 0, which has no ratio.
std::vector<Unknown> ParseUnknowns(const std::vector<std::string>& names, const Robot& robot,
                                   Method method, const std::string& where);

/// x of the nominal robot.
Eigen::VectorXd StartOf(const std::vector<Unknown>& unknowns, const Robot& nominal);
/// Lowest and highest plausible x: stiffness within a factor 100, radii within 2, 0 <= mu <= 0.999,
/// angles within pi, precurvature within 20 rad, nu within -1 and 0.5.
Eigen::VectorXd LowestOf(const std::vector<Unknown>& unknowns, const Robot& nominal);
Eigen::VectorXd HighestOf(const std::vector<Unknown>& unknowns, const Robot& nominal);

/// The value of an unknown is x times this [SI]: E or EI, GJ, density or mass per length,
/// disk_mass, precurvature, the angle added, the first radius, mu, base_rotation.
double UnitOf(const Unknown& unknown, const Robot& nominal);

/// The nominal robot with x in place.
Robot Changed(const Robot& nominal, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& x);

}  // namespace continuum::tdcr
