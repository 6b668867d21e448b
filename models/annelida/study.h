#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "models/annelida/planar_chain.h"
#include "sim/system.h"

namespace continuum {

/// Joint angles of a run, and what pulled.
struct Course {
  std::vector<double> time, tension;  ///< [s], of cable 1 [N]
  std::vector<Joints> q;              ///< [rad]
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

/// In MuJoCo with the plugin, at step h [s].
BendResult BendMujoco(const System& annelida, const BendAndRelease& plan, double h);
/// By the chain written out, at step h [s].
BendResult BendChain(const PlanarChain& chain, const BendAndRelease& plan, double h);

}  // namespace continuum
