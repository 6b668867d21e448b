#pragma once

#include <span>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// An entry of a segment's Jacobian dL/dq that is not zero. Its degree of freedom moves the far end
/// (sign +1) or the near end (−1) of the segment and not the other.
struct JacobianEntry {
  int dof;
  double sign;
};

/// A spatial tendon through sites s_0 (actuator side) .. s_n (fixed end). Segment k runs from s_k
/// to s_{k+1}; contact i is the interior site s_i, 1 ≤ i < n.
struct Cable {
  int tendon;
  std::vector<int> sites;
  std::vector<int> actuators;
  std::vector<JacobianEntry> entries;  ///< of all segments
  std::vector<int> begin;              ///< [segments + 1] of a segment's entries

  int segments() const { return static_cast<int>(sites.size()) - 1; }
  bool Rigid(int k) const { return begin[k] == begin[k + 1]; }
};

/// Throws Error when the tendon is not a spatial tendon through sites only, at least three.
Cable MakeCable(const mjModel& m, int tendon, const std::string& who);

/// Tension at the actuator's end [N]: −sum(gear · force), forces within their ranges.
double BaseTension(const mjModel& m, const mjData& d, const Cable& cable);

}  // namespace continuum
