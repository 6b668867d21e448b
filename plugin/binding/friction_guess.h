#pragma once

#include <vector>

#include <mujoco/mujoco.h>

#include "binding/articulated_inertia.h"

namespace continuum {

/// Where MuJoCo's solver begins in trees of joints with dry friction of ours and no other
/// constraint: at the answer, without which it needs an iteration each time that another joint
/// begins to slide. The solver ends where its cost falls by less than its tolerance. Of many stiff
/// rows one behind the other it does not know the forces by then, and joints creep. Trees in which
/// all friction is MuJoCo's own are left to it, bit by bit.
///
/// Once it is known which rows hold, the accelerations a follow from
///
///   (M + diag D_held) a = F + D_held a_ref ± level_slides                              (1)
///   a row holds where |D (a_ref − a)| <= level, else it slides with the sign of that   (2)
///
/// D, a_ref of a row · F all other forces. It begins with who holds at the acceleration of the last
/// step, and lets all rows that break (2) change as long as that leaves fewer, else one by one
/// (judice1994); articulated bodies solve (1). Where that does not end, the solver begins as
/// before. Source: MuJoCo's constraint model.
class FrictionGuess {
 public:
  explicit FrictionGuess(const mjModel& m);

  /// Once the levels of all rows are known: writes qacc_warmstart.
  void Write(const mjModel& m, mjData& d);

 private:
  struct Tree {
    int id;
    std::vector<int> dofs;
    ArticulatedInertia inertia;
  };
  bool Solve(const mjModel& m, const mjData& d, Tree& tree);
  int Judge(const mjData& d, const Tree& tree, const double* acceleration);
  void Change(const Tree& tree, bool one);

  std::vector<Tree> trees_;
  std::vector<int> row_;        // [nv] of each degree of freedom; −1: none
  std::vector<int> side_;       // [nv] 0: holds; ±1: sign of the force of one that slides
  std::vector<int> better_;     // [nv] what it should be
  std::vector<double> force_;   // [nv] F
  std::vector<double> held_;    // [nv] D_held
  std::vector<double> answer_;  // [dofs of a tree]
};

}  // namespace continuum
