#pragma once

#include <span>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/config.h"

namespace continuum {

/// An entry of a segment's Jacobian dL/dq that is not zero. Its degree of freedom moves the far end
/// (sign +1) or the near end (−1) of the segment and not the other.
struct JacobianEntry {
  int dof;
  double sign;
};

/// Where a cable touches the robot: a site, or one of the two tangent points of a wrapped geom.
struct CablePoint {
  int site;  ///< −1: a tangent point
  int geom;  ///< −1: a site
  int body;
  int item;  ///< of the tendon's path, as mjModel counts them (wrap_type)
};

/// A branch of a spatial tendon, from its driven end to where it is fixed, or to its other driven
/// end. Without pulleys a tendon is one branch. Segment k runs straight from point k to point k +
/// 1; between the two tangent points of a geom the cable lies on that geom, and there is no
/// segment. Contact k is what segment k − 1 and k meet at, 1 ≤ k < segments(): an interior site or
/// a wrapped geom.
struct Cable {
  int tendon;
  std::vector<int> sites;              ///< of the branch, in this order
  std::vector<int> actuators;          ///< that pull the tendon
  std::vector<JacobianEntry> entries;  ///< of all segments
  std::vector<int> begin;              ///< [segments + 1] of a segment's entries
  double divisor = 1;                  ///< it carries the tendon's tension by this
  bool from_last = false;              ///< driven at the end that the MJCF writes last
  bool both = false;                   ///< pulled at both ends: it is fixed nowhere
  struct Segment {
    CablePoint near, far;
  };
  std::vector<Segment> path;  ///< [segments]

  int segments() const { return static_cast<int>(path.size()); }
  bool Rigid(int k) const { return begin[k] == begin[k + 1]; }
  bool Wraps() const;
};

/// Which end of a tendon is pulled.
enum class Driven { kFirst, kLast, kBoth };

/// Why friction cannot act on a tendon ("a fixed tendon").
Misfit WhyNoCable(const mjModel& m, int tendon);

/// The branches of a tendon. One without contacts has one segment, and the tension T/divisor.
std::vector<Cable> MakeCables(const mjModel& m, int tendon, Driven driven);

/// What pulls a tendon [N] but for rows of the constraint solver: −sum(gear · force) of its
/// actuators, forces within their ranges, its spring, and its damper and those of its actuators.
double NativeTension(const mjModel& m, const mjData& d, const Cable& cable);

}  // namespace continuum
