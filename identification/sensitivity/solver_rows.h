#pragma once

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "identification/sensitivity/number_tangents.h"
#include "identification/sensitivity/tendon_derivatives.h"

namespace continuum {

/// The rows of MuJoCo's constraint solver that act in a step, to first order: dry friction and
/// limits of joints and tendons, equalities of joints. With J the row's Jacobian and f its force,
/// a row that slides has the level of its friction, f = ± level; one that holds obeys
///
///   f = −D (J a + B J q̇ + K I (x − m)),   D = I/((1 − I) W)                       (1)
///
/// with x its position, m its margin, W the inverse inertia that MuJoCo takes for it, I(x) its
/// impedance, K and B its stiffness and damping. Which rows slide, hold or give nothing is taken
/// from the step, so that by the implicit function theorem
///
///   (M + Σ_hold D Jᵀ J) da = dF + Σ Jᵀ (df at the same a)                          (2)
class SolverRows {
 public:
  /// What rows a model may have beyond these ("there are contacts"); empty: none.
  static std::string Obstacle(const mjModel& m);
  SolverRows(const mjModel& m, std::span<const ModelAndData* const> perturbed, double move);

  /// Takes up the rows of the step that d has just taken; false: one of them is none of these.
  bool Find(const mjModel& m, const mjData& d);
  bool empty() const { return rows_.empty(); }
  /// Adds to pull [ntendon] the forces of rows along tendons.
  void AddPulls(const mjData& d, std::span<double> pull) const;

  /// df at the same accelerations of the solver, d.qacc; tendons: placed at d.
  void Differentiate(const mjModel& m, const mjData& d, const TendonDerivatives& tendons,
                     const NumberTangents& numbers);
  /// force += Σ Jᵀ df, and what J itself changes.
  void AddForces(const mjData& d, const Tangents& position, Tangents& force) const;
  /// The same with what the moment arms of tendons change: d qfrc_constraint.
  void AddConstraint(const mjModel& m, const mjData& d, const TendonDerivatives& tendons,
                     const Tangents& position, Tangents& force) const;
  /// inertia += Σ_hold D Jᵀ J.
  void AddInertia(const mjData& d, Eigen::MatrixXd& inertia) const;
  /// df follows what the accelerations change by: df −= D J da of rows that hold.
  void Follow(const mjData& d, const Tangents& acceleration);
  /// What friction that slides would be off its anchor at rest, −R f/(K I), to first order.
  void WriteYields(const mjModel& m, const mjData& d, Tangents& yield) const;

 private:
  /// A row has the Jacobian of a tendon, or that of one or two joints.
  struct Row {
    int row;
    bool friction, slides;
    double sign;  ///< of the force of a row that slides
    int tendon = -1;
    int dof[2] = {-1, -1};
    double arm[2] = {1,
                     0};  ///< the Jacobian at the dofs; [0] of a tendon: times that of the tendon
    double curve = 0;     ///< d arm[1]/d q of dof[1]
    std::vector<std::pair<int, double>> jacobian{};  ///< entries of J
  };
  Row RowOf(const mjModel& m, const mjData& d, int r) const;
  static void Equality(const mjModel& m, const mjData& d, Row& row);
  /// J x.
  static Eigen::RowVectorXd Along(const Row& row, const Tangents& x);
  /// dJ x [nv].
  Eigen::RowVectorXd Turned(const Row& row, const TendonDerivatives& tendons, const double* x,
                            const Tangents& position);
  /// dW/W.
  Eigen::RowVectorXd Weight(const mjModel& m, const Row& row) const;
  Eigen::RowVectorXd Sliding(const Row& row, const NumberTangents& numbers) const;
  Eigen::RowVectorXd Holding(const mjModel& m, const mjData& d, const Row& row,
                             const TendonDerivatives& tendons, const NumberTangents& numbers);
  static void FillJacobian(const mjModel& m, const mjData& d, Row& row);

  std::vector<Row> rows_;
  Tangents change_;                  ///< df [rows_]
  Tangents loss_, tendon_loss_;      ///< native friction
  Tangents weight_, tendon_weight_;  ///< W
  std::vector<double> bent_;
};

}  // namespace continuum
