#pragma once

#include <span>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// A spatial tendon through sites s_0 (actuator side) .. s_n (fixed end), and what its friction
/// needs. Segment k runs from s_k to s_{k+1}; contact i is the interior site s_i, 1 ≤ i < n.
struct Cable {
  int tendon;
  std::vector<int> sites;
  std::vector<int> actuators;
  /// Largest eigenvalue of D M⁻¹ Dᵀ at qpos0 [1/kg], D_i = d(cable length distal of contact i)/dq:
  /// how strongly friction forces at the contacts accelerate the cable over them. It bounds the
  /// stick stiffness that an explicit step can carry.
  double compliance;

  int segments() const { return static_cast<int>(sites.size()) - 1; }
};

/// Throws Error when the tendon is not a spatial tendon through at least two sites only.
Cable MakeCable(const mjModel& m, int tendon, const std::string& who);

/// Tension at the actuator's end [N]: −sum(gear · force), forces within their ranges.
double BaseTension(const mjModel& m, const mjData& d, const Cable& cable);

/// Directions, wrap angles and sliding speeds of one cable.
struct CableGeometry {
  std::vector<double> direction;  ///< [3 · segments] unit vectors s_k → s_{k+1}
  std::vector<double> theta;  ///< [segments] wrap angle at contact i = 1 .. (entry 0 unused) [rad]
  std::vector<double> arm;    ///< [3 * sites] from the centre of mass of the tree of the site
  std::vector<double> slip;   ///< [segments] v_i = −Σ_{k ≥ i} dL_k/dt, > 0 when pulled [m/s]

  void Update(const mjModel& m, const mjData& d, const Cable& cable);
};

/// Wrenches on bodies about the centre of mass of their tree, mapped to generalized forces.
class BodyWrenches {
 public:
  BodyWrenches(const mjModel& m, std::span<const Cable> cables);

  /// Adds what a cable does to its sites beyond the tension that it has at its base. tension: of
  /// its segments [N].
  void Add(const mjModel& m, const Cable& cable, const CableGeometry& at, const double* tension);
  /// force[nv] = Jᵀ · wrenches, and clears them.
  void Collect(const mjModel& m, const mjData& d, std::span<double> force);

 private:
  std::vector<int> bodies_;     ///< all that carry sites, with their ancestors, ascending
  std::vector<double> wrench_;  ///< [6 · nbody] torque, force
};

}  // namespace continuum
