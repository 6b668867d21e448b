#pragma once

#include <span>
#include <vector>

#include "binding/cable_geometry.h"
#include "binding/linear_solver.h"
#include "binding/step_inertia.h"

namespace continuum {

/// Contacts of a cable between which nothing moves, and the moving segment behind them.
struct Bend {
  int cable, segment;  ///< segment as CableGeometry counts them
  double band;    ///< largest |ρ|, ρ = log(tension behind/tension before), sum over the contacts
  double grown;   ///< exp(band)
  double memory;  ///< ρ of the last step
  double speed;   ///< v, > 0 when pulled toward the actuator, as the step begins [m/s]
  double level;   ///< log(tension behind/base tension) of the last step
  bool fresh;     ///< no step has gone before

  int side = 0;                   ///< ±1: slides with ρ = ±band; 0: at rest
  double tension = 0, ratio = 1;  ///< behind it [N]; the same by that before it
  bool given = false;             ///< slides as its speed says, whatever it is at the step's end
};

/// A row of the constraint solver that pulls cables (TensionRow), for the solver of their friction.
struct SolvedRow {
  bool limit;                   ///< its force is not negative
  double stiffness, reference;  ///< D, a_ref
  std::vector<double> J;        ///< [nv]
  std::vector<double> on;       ///< [cables] tension for each unit of its force
  bool acts = true;
};

/// Dry friction of cables, solved for the end of the step.
///
/// The tensions t_g behind the bends g of a cable with base tension t_0 move the robot by
///
///   M (q̇⁺ − q̇) = h (F − Σ_g (t_g − t_0) dL_g/dq)                        (1)
///
/// with all other forces F and M as in StepInertia. Rows of the solver that pull cables add
///
///   J^T λ to F and c λ to t_0,   λ = D (a_ref − J (q̇⁺ − q̇)/h)           (1a)
///
/// where λ ≥ 0 or the row is an equality. Each bend obeys one of
///
///   v_g⁺ ≥ 0, ρ_g = −band;   v_g⁺ ≤ 0, ρ_g = +band;   |ρ_g| ≤ band, v_g⁺ = 0       (2)
///   v_g = −Σ_{k ≥ g} dL_k/dt,   ρ_g = log(t_g/t_{g−1})                   (3)
///
/// which holds for any inertia and step: what can stop within the step stops, what rests stays.
/// Bends at rest may be more than what moves can tell apart. Each therefore gives way a little,
///
///   v_g⁺ = v_c (memory − ρ_g)/band,   v_c = 1 mm/s,                      (4)
///
/// so that nothing changes without need. A step takes what gave way as the new memory: a bend at
/// rest is a spring that reaches its band after h v_c, with a damper of v_c, and does not creep.
///
/// Where no step has gone before, bends faster than 20 mm/s slide as their speed says, whatever it
/// is at the step's end: one mj_forward on fresh data gives the law at that state. Not so where
/// friction as large as that would throw a bend back, beyond rest by more than 0.2 m/s in the step.
///
/// Once it is known who slides which way, (1) is linear in q̇⁺, with a linear ρ in (4): ρ − memory =
/// (t_g − e^memory t_{g−1})/t, t what t_g would be by the memories or was, if that is more. Bends
/// that break (2) then change their part: all together as long as that leaves fewer to change, else
/// one by one (block principal pivoting; judice1994). Where that does not end, v_c grows until it
/// does, and comes back from what was found.
class CableSliding {
 public:
  struct World {
    const mjModel& m;
    mjData& d;
    const CableGeometry& geometry;
    std::span<const double> native;  ///< tension of each cable but for rows [N]
    std::span<double> base;  ///< all of it, > 0 where it has bends; found for cables with rows
    std::span<const double> last;   ///< the same in the last step [N]
    std::span<const double> force;  ///< F [nv]
    std::span<SolvedRow> rows;
  };
  /// rows: further degrees of freedom that rows act on.
  CableSliding(const mjModel& m, const CableGeometry& geometry, std::span<const int> rows);

  /// Cables in separate kinematic trees do not couple: each island of them is solved by itself. A
  /// law with cables in one order of islands has them in contiguous runs.
  int islands() const { return static_cast<int>(inertias_.size()); }
  /// Degrees of freedom of all islands.
  const std::vector<int>& dofs() const { return dofs_; }
  /// Of the island solved last.
  const StepInertia& inertia() const { return inertias_[island_]; }
  /// v_c and q̇⁺ − q̇ [inertia().dofs()] of the last solution that has bends at rest.
  double give_way() const { return answer_.give_way; }
  const std::vector<double>& change() const { return answer_.velocity; }
  /// Finds side and tension of the bends, cable after cable, each from its base on.
  void Solve(const World& w, std::span<Bend> bends);

 private:
  struct Part {
    double ratio;  // of the tension behind it to that before: exp of ρ when sliding, else of memory
    double yield;  // d tension/d v of a bend at rest [N s/m]
    int better;    // side it should have
  };
  void Guess(const World& w, std::span<Bend> bends);
  void GiveFresh(const World& w, std::span<Bend> bends);
  void Changes(const World& w, std::span<const Bend> bends, std::span<const double> force);
  void AddPlaces(const CableGeometry& geometry, int cable);
  void SolveIslands(const World& w, std::span<Bend> bends);
  void Begin(const World& w, int island);
  void SolveSides(const World& w, std::span<Bend> bends);
  void TakeRows(const World& w);
  bool ReleaseRows(const World& w);
  bool Settle(const World& w, std::span<Bend> bends);
  void Assign(const World& w, std::span<const Bend> bends);
  int FirstAtRest(std::span<const Bend> bends) const;
  void Assemble(const World& w, std::span<const Bend> bends);
  void Follow(const World& w, const Bend& bend, double f, std::span<double> follow) const;
  int Judge(const World& w, std::span<Bend> bends);
  void Change(std::span<Bend> bends, bool one);

  /// Base tension of a cable with rows: constant − Σ_j slope_j (q̇⁺ − q̇)_j.
  struct RowBase {
    bool rows = false;
    double constant = 0;
    std::vector<double> slope;  ///< [dofs]
  };
  double BaseOf(const World& w, int cable) const;

  std::vector<int> island_of_;         ///< [cables]
  std::vector<StepInertia> inertias_;  ///< [islands]
  std::vector<int> dofs_;
  int island_ = 0;
  std::vector<RowBase> row_base_;          ///< [cables]
  std::vector<double> matrix_, pushed_;    ///< inertia and F with the rows that act
  std::span<const double> system_, push_;  ///< what is solved: inertia and F [nv]
  BlockSolver solver_;
  std::vector<int> place_;  ///< [entries] of its dof in the inertia of its island
  std::vector<int> least_;  ///< [segments] the first place that moves it or what is distal of it
  double give_way_ = 0;     ///< v_c
  struct {
    double give_way = 0;
    std::vector<double> velocity;
  } answer_;
  std::vector<Part> parts_;
  std::vector<Bend> found_;
  std::vector<double> follow_;          ///< [dofs]
  std::vector<double> velocity_;        ///< [dofs] q̇⁺ − q̇
  std::vector<double> change_, speed_;  ///< [bends] of v in the step; v⁺
  std::vector<double> work_, none_;     ///< [nv]
};

}  // namespace continuum
