#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// A row of the constraint solver that is solved together with the friction of cables.
///
///   λ = D (a_ref − J a)                                                      (1)
///
/// λ its force [N] · a acceleration of the degrees of freedom. Source: MuJoCo's constraint model.
struct SolvedRow {
  int row;                      ///< of mjData's efc arrays
  bool limit;                   ///< λ ≥ 0, as of a contact or a limit
  double stiffness, reference;  ///< D, a_ref
  std::vector<int> dof;         ///< of the entries of J that may differ from zero
  std::vector<double> J;        ///< [dof]
  std::vector<double> on;       ///< [cables] tension for each unit of λ; empty: none
  bool acts;                    ///< λ > 0, or no limit

  double On(std::size_t cable) const { return on.empty() ? 0 : on[cable]; }
};

/// The solved rows of a step; they keep their memory from step to step.
class SolvedRows {
 public:
  void Clear() { count_ = 0; }
  /// Takes up a row of d as (1) has it, without effect on cables.
  SolvedRow& Add(const mjModel& m, mjData& d, int row, bool limit);
  std::span<SolvedRow> all() { return {rows_.data(), count_}; }

 private:
  std::vector<SolvedRow> rows_;
  std::size_t count_ = 0;
};

/// Takes up the rows of contacts: of frictionless and pyramidal ones all, of elliptic ones that of
/// the normal force.
void AddContactRows(const mjModel& m, mjData& d, SolvedRows& rows);

/// force[nv]: what the constraint solver did in the step that d has just taken, but for rows of
/// contacts, as above, and the given ones. Where an elliptic contact slides, the normal force is
/// not that of (1): the difference counts.
void OtherConstraintForces(const mjModel& m, const mjData& d, std::span<const int> rows,
                           std::vector<double>& force);

}  // namespace continuum
