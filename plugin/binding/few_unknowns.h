#pragma once

#include <span>
#include <vector>

#include "binding/bend.h"
#include "binding/cable_geometry.h"
#include "binding/cable_islands.h"
#include "binding/step_damping.h"

namespace continuum {

/// The change of the velocities in a step, (1) of CableSliding, solved for what resists motion
/// instead of for all joints: bends at rest, and what the damping has beyond its diagonal, dampers
/// along J of tendons and actuators with h d. These are few, where there are many joints.
///
/// Without them the inertia is K, which ArticulatedInertia solves with. What resists with p
/// measures along c and pushes along w, with the ratios r of Part,
///
///   K x = b + h Σ p w,   p = y cᵀ x                                                       (1)
///
/// with of bends and of dampers
///
///   p = drop,  y = yield,  c_g = −Σ_{k ≥ g} dL_k/dq,  w_g = Σ_{k ≥ g} (r_{g+1} … r_k) dL_k/dq
///              y = h d,    c = J,                     w = −J/h
///
/// b the right-hand side with all p = 0. So
///
///   p_i − h y_i Σ_j (z_iᵀ w_j) p_j = y_i z_iᵀ b,   z_i = K⁻¹ c_i                           (2)
///
/// has as many unknowns as resist, and z_i is the same whoever slides: it is found once in a step.
/// A cable that runs along itself by u adds u to cᵀ x of its bends, and
///
///   drag u + Σ_g (r_{g+1} … r_last) p_g = t_last − t_0 with all p = 0                       (3)
class FewUnknowns {
 public:
  struct World {
    const mjModel& m;
    const mjData& d;
    const CableGeometry& route;
    CableIslands& islands;
    int island;
    const StepDamping& damping;
    std::span<const double> force;  ///< F [nv]
    std::span<const double> base;   ///< tension of each cable [N]
  };
  /// Of an island and a step: force and base then stay as they are.
  void Begin(const World& w, std::span<const Bend> bends);
  /// x: q̇⁺ − q̇, behind it the change of u of each cable that runs along itself. Finds all drops.
  void Solve(const World& w, std::span<const Bend> bends, std::span<Part> parts,
             std::span<double> x);

 private:
  // Of four that resist, side by side.
  struct Measures {
    int what[4];                 // bend, or ~ the number of a damper's term; kNobody
    std::vector<double> change;  // [joints · 4] z
    std::vector<double> along;   // [bends · 4] z · dL_g/dq
    double by_force[4];          // z · F
  };
  // Their rows of (2): −1 for what does not resist now.
  struct Rows {
    int at[4];
    double yield[4];
  };
  void MeasureAll(const World& w, std::span<const Bend> bends);
  void Measure(const World& w, std::span<const Bend> bends, std::span<const int> resisting);
  void PutPath(const World& w, std::span<const Bend> bends, int what, double* c) const;
  void Number(const World& w, std::span<const Bend> bends, std::span<const Part> parts);
  Rows RowsOf(const World& w, std::span<const Part> parts, const Measures& measures) const;
  void FillRows(const World& w, std::span<const Bend> bends, std::span<const Part> parts,
                const Measures& measures);
  void FillDampers(const World& w, const Measures& measures, const Rows& rows);
  void FillEnd(const World& w, std::span<const Bend> bends, std::span<const Part> parts, int end);
  void Push(const World& w, std::span<const Bend> bends, std::span<Part> parts,
            std::span<double> x) const;
  void Fill(const Rows& rows, int column, const double* by, double scale);

  std::vector<Measures> measures_;  // of which the first measured_ are of this step
  std::size_t measured_ = 0;
  std::vector<bool> known_;       // [bends] has been measured
  std::vector<int> dampers_;      // terms of the damping on the island
  std::vector<int> resisting_;    // to be measured
  std::vector<int> unknown_;      // [bends] number of its p; −1: slides
  std::vector<int> ends_;         // bends, each the last of a cable that runs along itself
  int rests_ = 0;                 // unknowns: bends at rest, then dampers, then ends
  std::vector<double> constant_;  // [bends] tension with all p = 0
  std::vector<double> matrix_, p_;
};

}  // namespace continuum
