#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// What MuJoCo makes of solref and solimp for a row of its constraint solver.
///
///   a_ref = −B v − K d (x − margin)                                          (1)
///
/// Source: MuJoCo's manual, solver parameters.
struct RowImpedance {
  double stiffness;  ///< K [1/s²]
  double damping;    ///< B [1/s]
  double value;      ///< d [1]
};

/// Of a contact, a limit of a tendon or an equality. As mjData's efc_KBIP, which the discrete
/// integrator has only once all forces are known.
RowImpedance RowImpedanceOf(const mjModel& m, const mjData& d, int row);

}  // namespace continuum
