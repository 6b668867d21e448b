#include "identification/sensitivity/solver_rows.h"

#include <algorithm>
#include <cmath>

#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

using Kind = Number::Kind;
using RowVector = Eigen::RowVectorXd;

// Of a polynomial Σ c_k x^k, its first and second derivative.
std::array<double, 2> Slopes(const double* c, double x) {
  return {c[1] + x * (2 * c[2] + x * (3 * c[3] + x * 4 * c[4])),
          2 * c[2] + x * (6 * c[3] + x * 12 * c[4])};
}

}  // namespace

std::string SolverRows::Obstacle(const mjModel& m) {
  if (m.opt.noslip_iterations > 0) return "the solver has steps against slip";
  for (int i = 0; i < m.neq; ++i) {
    if (m.eq_type[i] != mjEQ_JOINT) return "equality " + Called(m, mjOBJ_EQUALITY, i);
  }
  return "";
}

SolverRows::SolverRows(const mjModel& m, std::span<const ModelAndData* const> perturbed,
                       double move)
    : loss_(ArrayTangents(m, perturbed, move, &mjModel::dof_frictionloss, m.nv)),
      tendon_loss_(ArrayTangents(m, perturbed, move, &mjModel::tendon_frictionloss, m.ntendon)),
      weight_(ArrayTangents(m, perturbed, move, &mjModel::dof_invweight0, m.nv)),
      tendon_weight_(ArrayTangents(m, perturbed, move, &mjModel::tendon_invweight0, m.ntendon)) {}

bool SolverRows::Find(const mjModel& m, const mjData& d) {
  rows_.clear();
  for (int r = 0; r < d.nefc; ++r) {
    switch (d.efc_type[r]) {
      case mjCNSTR_LIMIT_JOINT:
      case mjCNSTR_LIMIT_TENDON:
        if (d.efc_force[r] <= 0) continue;
        [[fallthrough]];
      case mjCNSTR_EQUALITY:
      case mjCNSTR_FRICTION_DOF:
      case mjCNSTR_FRICTION_TENDON:
        rows_.push_back(RowOf(m, d, r));
        break;
      default:
        return false;
    }
  }
  return true;
}

// A row of friction at rest gives less than its level. One of level 0 opposes what it would hold.
SolverRows::Row SolverRows::RowOf(const mjModel& m, const mjData& d, int r) const {
  const int type = d.efc_type[r], id = d.efc_id[r];
  Row row{r, type == mjCNSTR_FRICTION_DOF || type == mjCNSTR_FRICTION_TENDON, false, 1};
  row.slides = row.friction && std::abs(d.efc_force[r]) >= d.efc_frictionloss[r] * (1 - 1e-9);
  if (type == mjCNSTR_FRICTION_DOF) row.dof[0] = id;
  if (type == mjCNSTR_LIMIT_JOINT) row.dof[0] = m.jnt_dofadr[id];
  if (type == mjCNSTR_FRICTION_TENDON || type == mjCNSTR_LIMIT_TENDON) row.tendon = id;
  if (type == mjCNSTR_EQUALITY) Equality(m, d, row);
  if (type == mjCNSTR_LIMIT_JOINT || type == mjCNSTR_LIMIT_TENDON) {
    const double* const range =
        (type == mjCNSTR_LIMIT_JOINT ? m.jnt_range : m.tendon_range) + 2 * id;
    const double x = row.tendon < 0 ? d.qpos[m.jnt_qposadr[id]] : d.ten_length[id];
    if (x > 0.5 * (range[0] + range[1])) row.arm[0] = -1;
  }
  FillJacobian(m, d, row);
  if (row.slides) {
    double held = -d.efc_aref[r];
    for (const auto& [dof, arm] : row.jacobian) held += arm * d.qacc[dof];
    row.sign = d.efc_force[r] != 0 ? std::copysign(1, d.efc_force[r]) : held > 0 ? -1 : 1;
  }
  return row;
}

// q₁ = polynomial of q₂, both from where they are in the model.
void SolverRows::Equality(const mjModel& m, const mjData& d, Row& row) {
  const int e = d.efc_id[row.row], first = m.eq_obj1id[e], second = m.eq_obj2id[e];
  row.dof[0] = m.jnt_dofadr[first];
  if (second < 0) return;
  const int adr = m.jnt_qposadr[second];
  const auto [slope, curve] = Slopes(m.eq_data + mjNEQDATA * e, d.qpos[adr] - m.qpos0[adr]);
  row.dof[1] = m.jnt_dofadr[second];
  row.arm[1] = -slope, row.curve = -curve;
}

void SolverRows::FillJacobian(const mjModel& m, const mjData& d, Row& row) {
  if (row.tendon < 0) {
    for (int i = 0; i < 2 && row.dof[i] >= 0; ++i)
      row.jacobian.emplace_back(row.dof[i], row.arm[i]);
    return;
  }
  const int adr = m.ten_J_rowadr[row.tendon];
  for (int k = adr; k < adr + m.ten_J_rownnz[row.tendon]; ++k)
    row.jacobian.emplace_back(m.ten_J_colind[k], row.arm[0] * d.ten_J[k]);
}

void SolverRows::AddPulls(const mjData& d, std::span<double> pull) const {
  for (const Row& row : rows_) {
    if (row.tendon >= 0) pull[row.tendon] += row.arm[0] * d.efc_force[row.row];
  }
}

RowVector SolverRows::Along(const Row& row, const Tangents& x) {
  RowVector along = RowVector::Zero(x.cols());
  for (const auto& [dof, arm] : row.jacobian) along += arm * x.row(dof);
  return along;
}

RowVector SolverRows::Turned(const Row& row, const TendonDerivatives& tendons, const double* x,
                             const Tangents& position) {
  if (row.tendon < 0) {
    if (row.curve == 0) return RowVector::Zero(position.cols());
    return row.curve * x[row.dof[1]] * position.row(row.dof[1]);
  }
  bent_.assign(position.rows(), 0);
  tendons.AddBend(row.tendon, row.arm[0], x, bent_);
  return RowVector::Map(bent_.data(), std::ssize(bent_)) * position;
}

RowVector SolverRows::Weight(const mjModel& m, const Row& row) const {
  if (row.tendon >= 0) return tendon_weight_.row(row.tendon) / m.tendon_invweight0[row.tendon];
  RowVector change = RowVector::Zero(weight_.cols());
  double all = 0;
  for (int i = 0; i < 2 && row.dof[i] >= 0; ++i) {
    all += m.dof_invweight0[row.dof[i]];
    change += weight_.row(row.dof[i]);
  }
  return change / all;
}

RowVector SolverRows::Sliding(const Row& row, const NumberTangents& numbers) const {
  const auto native = row.tendon < 0 ? loss_.row(row.dof[0]) : tendon_loss_.row(row.tendon);
  return row.sign * (numbers[Kind::kLevel].row(row.row) + native);
}

// (1) at the same a. The impedance of friction follows no position, and native friction has none.
RowVector SolverRows::Holding(const mjModel& m, const mjData& d, const Row& row,
                              const TendonDerivatives& tendons, const NumberTangents& numbers) {
  const int r = row.row;
  const double *const k = d.efc_KBIP + 4 * r, impedance = k[2], D = d.efc_D[r];
  const double off = d.efc_pos[r] - d.efc_margin[r], steep = row.friction ? 0 : k[3];
  const Tangents& position = numbers[Kind::kPosition];
  const RowVector x =
      row.friction ? RowVector(numbers[Kind::kOffset].row(r)) : Along(row, position);
  const RowVector v = Along(row, numbers[Kind::kSpeed]) + Turned(row, tendons, d.qvel, position);
  const RowVector a = Turned(row, tendons, d.qacc, position);
  return -D * (a + k[1] * v + k[0] * (impedance + steep * off) * x) +
         d.efc_force[r] * (steep / (impedance * (1 - impedance)) * x - Weight(m, row));
}

void SolverRows::Differentiate(const mjModel& m, const mjData& d, const TendonDerivatives& tendons,
                               const NumberTangents& numbers) {
  change_.resize(std::ssize(rows_), numbers[Kind::kPosition].cols());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    change_.row(static_cast<Eigen::Index>(i)) =
        rows_[i].slides ? Sliding(rows_[i], numbers) : Holding(m, d, rows_[i], tendons, numbers);
  }
}

void SolverRows::AddForces(const mjData& d, const Tangents& position, Tangents& force) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    for (const auto& [dof, arm] : row.jacobian)
      force.row(dof) += arm * change_.row(static_cast<Eigen::Index>(i));
    if (row.curve != 0)
      force.row(row.dof[1]) += row.curve * d.efc_force[row.row] * position.row(row.dof[1]);
  }
}

void SolverRows::AddConstraint(const mjModel& m, const mjData& d, const TendonDerivatives& tendons,
                               const Tangents& position, Tangents& force) const {
  AddForces(d, position, force);
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(m.nv, m.nv);
  for (const Row& row : rows_) {
    if (row.tendon < 0) continue;
    const std::vector<double> pull(m.tendon_num[row.tendon], row.arm[0] * d.efc_force[row.row]);
    tendons.AddCurvature(row.tendon, pull, curvature);
  }
  force += curvature * position;
}

void SolverRows::AddInertia(const mjData& d, Eigen::MatrixXd& inertia) const {
  for (const Row& row : rows_) {
    if (row.slides) continue;
    const auto& entries = row.jacobian;
    for (const auto& [i, a] : entries) {
      for (const auto& [j, b] : entries) inertia(i, j) += d.efc_D[row.row] * a * b;
    }
  }
}

void SolverRows::Follow(const mjData& d, const Tangents& acceleration) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].slides) continue;
    change_.row(static_cast<Eigen::Index>(i)) -=
        d.efc_D[rows_[i].row] * Along(rows_[i], acceleration);
  }
}

void SolverRows::WriteYields(const mjModel& m, const mjData& d, Tangents& yield) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const int r = rows_[i].row;
    const double stiffness = d.efc_KBIP[4 * r] * d.efc_KBIP[4 * r + 2];
    if (!rows_[i].friction || stiffness == 0) continue;
    yield.row(r) =
        -d.efc_R[r] / stiffness *
        (change_.row(static_cast<Eigen::Index>(i)) + d.efc_force[r] * Weight(m, rows_[i]));
  }
}

}  // namespace continuum
