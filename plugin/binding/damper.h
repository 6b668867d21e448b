#pragma once

#include <cmath>

#include <mujoco/mujoco.h>

namespace continuum {

/// A damper of MuJoCo: of a degree of freedom, a tendon, or what the attribute damping of an
/// actuator adds to its joint or tendon, at the speed v.
///
///   f = b v + b₁ |v| v + b₂ v³                                              (1)
///
/// It resists with f [N or N*m] whatever the actuator gives. Source: MuJoCo's manual.
struct Damper {
  double linear;       ///< b
  const double* poly;  ///< [mjNPOLY] b₁, b₂
  double scale = 1;    ///< of f

  bool Any() const { return linear != 0 || poly[0] != 0 || poly[1] != 0; }
  double Force(double v) const {
    const double speed = std::abs(v);
    return scale * v * (linear + speed * (poly[0] + speed * poly[1]));
  }
  /// df/dv.
  double Slope(double v) const {
    const double speed = std::abs(v);
    return scale * (linear + speed * (2 * poly[0] + speed * 3 * poly[1]));
  }
};

inline Damper DofDamper(const mjModel& m, int dof) {
  return {m.dof_damping[dof], m.dof_dampingpoly + mjNPOLY * dof};
}
inline Damper TendonDamper(const mjModel& m, int tendon) {
  return {m.tendon_damping[tendon], m.tendon_dampingpoly + mjNPOLY * tendon};
}
/// By the speed of its joint or tendon.
inline Damper ActuatorDamper(const mjModel& m, int actuator) {
  const double gear = m.actuator_gear[6 * m.actuator_outadr[actuator]];
  return {m.actuator_damping[actuator], m.actuator_dampingpoly + mjNPOLY * actuator, gear * gear};
}

}  // namespace continuum
