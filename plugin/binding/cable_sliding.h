#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "binding/bend.h"
#include "binding/cable_geometry.h"
#include "binding/cable_islands.h"
#include "binding/few_unknowns.h"
#include "binding/island_rows.h"
#include "binding/solved_row.h"

namespace continuum {

/// Dry friction of cables, solved for the end of the step.
///
/// The tensions t_g behind the bends g of a cable with base tension t_0 move the robot by
///
///   M (q̇⁺ − q̇) = h (F − Σ_g (t_g − t_0) dL_g/dq)                        (1)
///
/// with all other forces F and M as in StepInertia. Rows of the constraint solver, of contacts and
/// those that pull cables, add
///
///   Jᵀ λ to F and c λ to t_0,   λ = D (a_ref − J a)                       (1a)
///
/// where λ ≥ 0 or the row is an equality, and a follows from q̇⁺ as IslandRows says. So a robot at
/// rest against a wall is at rest for its cables too. Each bend obeys one of
///
///   v_g⁺ ≥ 0, ρ_g = −band;   v_g⁺ ≤ 0, ρ_g = +band;   |ρ_g| ≤ band, v_g⁺ = 0       (2)
///   v_g = −Σ_{k ≥ g} dL_k/dt,   ρ_g = log(t_g/t_{g−1})                   (3)
///
/// A cable that is pulled with t_0 at both ends runs along itself, with a speed u that adds to all
/// its v_g. It has next to no mass, so that u is what makes the tension at the far end t_0:
///
///   Σ_g ρ_g = 0                                                                        (3a)
///
/// which holds for any inertia and step: what can stop within the step stops, what rests stays.
/// Bends at rest may be more than what moves can tell apart. Each therefore gives way a little,
///
///   v_g⁺ = v_c (memory − ρ_g)/band,   v_c = 1 mm/s,                      (4)
///
/// so that nothing changes without need. A step takes what gave way as the new memory: a bend at
/// rest is a spring that reaches its band after h v_c, with a damper of v_c, and does not creep. A
/// cable that gives by more than that has v_c = give/h; there a bend slides from the speed on with
/// which (4) would leave the band.
///
/// Where no step has gone before, bends faster than 20 mm/s slide as their speed says, whatever it
/// is at the step's end: one mj_forward on fresh data gives the law at that state. Not so where
/// friction as large as that would throw a bend back, beyond rest by more than 0.2 m/s in the step.
///
/// A bend that comes into the step faster than 5 v_c and leaves it the other way slides both ways
/// in it. With ρ = +band or −band on the old side it would end at v₁, from rest on the new side it
/// would gain w (its change of speed over a whole step). Where v₁ and w have the new direction it
/// turns after the part τ of the step, and hands on the mean of both tensions:
///
///   τ = v/(v − v₁),   t_g = (τ e^(old ρ) + (1 − τ) e^(new ρ)) t_{g−1}         (5)
///
/// So v⁺ = (1 − τ) w, what the two stretches give with constant forces. (2) alone would let the new
/// direction act all along: an error of first order in the step at every reversal.
///
/// Once it is known who slides which way, (1) is linear in q̇⁺, with a linear ρ in (4): ρ − memory =
/// (t_g − e^memory t_{g−1})/t, t what t_g would be by the memories or was, if that is more. Many
/// joints are solved for by FewUnknowns; few, and those with rows, all together. Bends
/// that break (2), and rows that break λ ≥ 0 or that would push and do not, then change their part:
/// all together as long as that leaves fewer to change, else one by one (block principal pivoting;
/// judice1994). Where that does not end, v_c grows until it does, and comes back from what was
/// found.
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
    double give;  ///< sliding over which friction builds up; 0: v_c h [m]

    double GiveWay() const { return CableSliding::GiveWay(give, m.opt.timestep); }
    bool Gives() const { return GiveWay() > 1e-3; }
  };
  CableSliding(const mjModel& m, const CableGeometry& geometry);

  /// v_c of (4): 1 mm/s, or what makes the give of a cable.
  static double GiveWay(double give, double step) { return std::max(1e-3, give / step); }

  /// Islands of cables are solved each by itself. Rows of the last step may have linked some.
  int islands() const { return islands_.size(); }
  /// Whether v_c was the give of the cable, in the last solution.
  bool gives() const { return gives_; }
  /// Of the island solved last.
  const StepInertia& inertia() const { return islands_.inertia(island_); }
  /// v_c and q̇⁺ − q̇ [inertia().dofs()] of the last solution that has bends at rest.
  double give_way() const { return answer_.give_way; }
  const std::vector<double>& change() const { return answer_.velocity; }
  /// What (5) comes from where bends turned in the last solution: all bends, v_c and q̇⁺ − q̇ with
  /// those on their old side. No bends: none turned.
  struct Turn {
    std::vector<Bend> bends;
    double give_way = 0;
    std::vector<double> velocity;
  };
  const Turn& turn() const { return turn_; }
  /// Finds side and tension of the bends, cable after cable, each from its base on.
  void Solve(const World& w, std::span<Bend> bends);

 private:
  void Guess(const World& w, std::span<Bend> bends);
  void GiveFresh(const World& w, std::span<Bend> bends);
  void Changes(const World& w, std::span<const Bend> bends, std::span<const double> force);
  void SolveFree(const World& w, std::span<Bend> bends);
  void SolveWithRows(const World& w, std::span<Bend> bends, int island);
  void Begin(const World& w, int island);
  void SolveSides(const World& w, std::span<Bend> bends);
  bool Settle(const World& w, std::span<Bend> bends);
  void TurnWithinStep(const World& w, std::span<Bend> bends);
  bool SolveTurns(const World& w, std::span<Bend> bends);
  bool SettleForced(const World& w, std::span<Bend> bends, int way);
  void Assign(const World& w, std::span<const Bend> bends);
  void SolveVelocity(const World& w, std::span<const Bend> bends);
  void BeginFree(const World& w, std::span<const Bend> bends);
  void SolveDense(const World& w, std::span<const Bend> bends);
  void Assemble(const World& w, std::span<const Bend> bends);
  void Follow(const World& w, const Bend& bend, double f, std::span<double> follow) const;
  int Judge(const World& w, std::span<Bend> bends);
  void Change(std::span<Bend> bends, bool one);

  double BaseOf(const World& w, int cable) const;
  double EndSpeed(int cable) const;
  void BalanceBySlowest(const World& w, std::span<Bend> cable) const;

  CableIslands islands_;
  int island_ = 0;
  IslandRows rows_;  ///< of the island that is being solved
  StepDamping damping_;
  bool damped_ = false;   ///< damping_ is that of this step
  bool covered_ = false;  ///< articulated bodies have the model's inertia
  bool few_ = false;      ///< solved for what resists, else for all joints
  FewUnknowns few_unknowns_;
  std::vector<double> matrix_;  ///< what is solved for all joints [dofs · dofs]
  double give_way_ = 0;         ///< v_c
  bool gives_ = false;
  struct {
    double give_way = 0;
    std::vector<double> velocity;
  } answer_;
  std::vector<Part> parts_;
  std::vector<Bend> found_, some_;  ///< the last answer; the bends of an island with rows
  std::vector<Bend> before_turns_;  ///< the answer by (2) alone
  std::vector<bool> turns_;         ///< [bends] may turn within the step
  Turn turn_;
  std::vector<double> kept_;            ///< [bends] v₁ of (5)
  std::vector<double> follow_;          ///< [dofs]
  std::vector<double> velocity_;        ///< [dofs] q̇⁺ − q̇
  std::vector<double> change_, speed_;  ///< [bends] of v in the step; v⁺
  std::vector<double> work_, none_;     ///< [nv]
};

}  // namespace continuum
