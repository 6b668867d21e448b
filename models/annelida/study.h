#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

#include "models/annelida/planar_chain.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Joint angles of a run, and what pulled.
struct Course {
  std::vector<double> time, tension;  ///< [s], of cable 1 [N]
  std::vector<PlanarJoints> q;        ///< [rad]
};

/// The static bend and the release of the paper, section 3.3: cable 1 is pulled at `rate` until the
/// tip has turned by 90°, held, then let go.
struct BendAndRelease {
  double rate = 2, hold = 2, after = 3;  ///< [N/s], [s], [s]
  double period = 0.01;                  ///< of the rows [s]
};

struct BendResult {
  Course bend, release;  ///< up to the end of the hold; from the release on
  double tension = 0;    ///< at which the tip had turned by 90° [N]
};

/// In MuJoCo with the plugin, at step h [s]. held: sees the arm at the end of the hold.
BendResult BendMujoco(const ModelSpec& annelida, const BendAndRelease& plan, double h,
                      const std::function<void(const mjModel&, const mjData&)>& held = {});
/// By the chain written out, at step h [s].
BendResult BendChain(const PlanarChain& chain, const BendAndRelease& plan, double h);

/// The study: in MuJoCo at 2 ms, 0.5 ms and 0.1 ms, and by the chain.
struct Study {
  AnnelidaParameters p;
  BendAndRelease plan;
  BendResult coarse, medium, fine, reference;
};

/// Equal angles of the same sum.
PlanarJoints Even(const PlanarJoints& q);
/// The paper's arc of the arm's length that turns as far as the joints: world x and z of n points
/// from the base to the tip.
Eigen::Matrix2Xd ArcPoints(const AnnelidaParameters& p, const PlanarJoints& q, int n);
/// The row of a course at a time [s].
PlanarJoints At(const Course& course, double time);

}  // namespace continuum
