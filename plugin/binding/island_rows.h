#pragma once

#include <span>
#include <vector>

#include "binding/linear_solver.h"
#include "binding/solved_row.h"
#include "binding/step_inertia.h"

namespace continuum {

/// Rows of the constraint solver on an island of cables, while the friction there is solved: which
/// of them act, and what these add to its equations.
///
///   (M + h D + Σ Jᵀ κ R) x = h (F + Σ Jᵀ κ a_ref),   R = J M⁻¹ (M + h D)      (1)
///
/// x the change of the velocity in the step · M, D as in StepInertia · κ, a_ref of a row
/// (SolvedRow). MuJoCo finds the forces of rows without the damping that its integrator takes
/// implicitly afterwards, for the acceleration M⁻¹ (M + h D) x/h.
class IslandRows {
 public:
  /// which: of all rows; native: tension of each cable but for rows [N].
  void Begin(const mjModel& m, const mjData& d, const StepInertia& inertia,
             std::span<SolvedRow> all, std::span<const int> which, std::span<const double> native);
  void End() { rows_.clear(); }
  bool empty() const { return rows_.empty(); }
  std::size_t size() const { return rows_.size(); }

  /// The matrix of (1) [n · n], and what its right-hand side has beyond h F [n].
  const std::vector<double>& matrix() const { return matrix_; }
  const std::vector<double>& push() const { return push_; }
  /// Tension that rows that act, and all else, give to a cable at its base [N]: constant − slope ·
  /// x.
  struct Base {
    bool rows = false;
    double constant = 0;
    std::vector<double> slope;  ///< [n]
    double At(std::span<const double> x) const;
  };
  const Base& base(int cable) const { return bases_[cable]; }

  /// How many rows have to begin or to end acting where x is the answer.
  int Judge(std::span<const double> x);
  /// Lets them: all, or only the last; whether there was one.
  bool Change(bool one);
  /// Which rows act, to come back to.
  std::vector<bool> Acting() const;
  void Act(const std::vector<bool>& acting);

 private:
  void FindResponses(const mjModel& m, const mjData& d, const StepInertia& inertia);
  void Build();
  void AddBase(const SolvedRow& row, const double* response);

  int n_ = 0;
  double step_ = 0;
  std::vector<SolvedRow*> rows_;
  std::vector<double> J_, R_;  // [rows · n]
  std::vector<bool> wrong_;
  std::span<const double> native_;
  std::vector<double> damped_, mass_, matrix_, push_;  // [n · n], the last [n]
  BlockSolver solver_;
  std::vector<Base> bases_;
};

}  // namespace continuum
