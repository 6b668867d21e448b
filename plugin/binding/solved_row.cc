#include "binding/solved_row.h"

#include <algorithm>

#include "binding/row_impedance.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

void ReadJacobian(const mjModel& m, const mjData& d, SolvedRow& row) {
  row.dof.clear(), row.J.clear();
  const bool sparse = mj_isSparse(&m);
  const int begin = sparse ? d.efc_J_rowadr[row.row] : row.row * static_cast<int>(m.nv);
  const int entries = sparse ? d.efc_J_rownnz[row.row] : static_cast<int>(m.nv);
  for (int k = 0; k < entries; ++k) {
    if (d.efc_J[begin + k] == 0) continue;
    row.dof.push_back(sparse ? d.efc_J_colind[begin + k] : k);
    row.J.push_back(d.efc_J[begin + k]);
  }
}

// The discrete integrator makes rows once all forces are known; until then mjData has what another
// step left there.
RowImpedance ImpedanceOf(const mjModel& m, const mjData& d, int r) {
  if (IsDiscrete(m)) return RowImpedanceOf(m, d, r);
  const double* const kbip = d.efc_KBIP + 4 * r;
  return {kbip[0], kbip[1], kbip[2]};
}

// D; for the discrete integrator by the inverse inertia along the row, without damping and springs.
double StiffnessOf(const mjModel& m, mjData& d, const SolvedRow& row, double impedance) {
  if (!IsDiscrete(m)) return d.efc_D[row.row];
  std::vector<double> J(m.nv), y(m.nv);
  for (std::size_t k = 0; k < row.dof.size(); ++k) J[row.dof[k]] = row.J[k];
  mj_solveM(&m, &d, y.data(), J.data(), 1);
  const double inverse = mju_dot(J.data(), y.data(), static_cast<int>(m.nv));
  return impedance / ((1 - impedance) * std::max(inverse, mjMINVAL));
}

bool IsElliptic(const mjData& d, int r) { return d.efc_type[r] == mjCNSTR_CONTACT_ELLIPTIC; }
// The first row of an elliptic contact.
bool IsNormal(const mjData& d, int r) { return r == d.contact[d.efc_id[r]].efc_address; }

}  // namespace

SolvedRow& SolvedRows::Add(const mjModel& m, mjData& d, int r, bool limit) {
  if (count_ == rows_.size()) rows_.emplace_back();
  SolvedRow& row = rows_[count_++];
  row.row = r, row.limit = limit;
  ReadJacobian(m, d, row);
  const RowImpedance by = ImpedanceOf(m, d, r);  // d.efc_aref comes later without actuators
  row.stiffness = StiffnessOf(m, d, row, by.value);
  double speed = 0;
  for (std::size_t k = 0; k < row.dof.size(); ++k) speed += row.J[k] * d.qvel[row.dof[k]];
  row.reference = -by.damping * speed - by.stiffness * by.value * (d.efc_pos[r] - d.efc_margin[r]);
  row.acts = !limit || row.reference > 0;
  row.on.clear();
  return row;
}

void AddContactRows(const mjModel& m, mjData& d, SolvedRows& rows) {
  for (int r = d.ne + d.nf + d.nl; r < d.nefc; ++r) {
    if (!IsElliptic(d, r) || IsNormal(d, r)) rows.Add(m, d, r, true);
  }
}

void OtherConstraintForces(const mjModel& m, const mjData& d, std::span<const int> rows,
                           std::vector<double>& force) {
  force.assign(d.qfrc_constraint, d.qfrc_constraint + m.nv);
  const int contacts = d.ne + d.nf + d.nl;
  if (rows.empty() && contacts == d.nefc) return;
  std::vector<double> other(d.efc_force, d.efc_force + contacts), acceleration;
  other.resize(d.nefc, 0);
  for (const int r : rows) other[r] = 0;
  for (int r = contacts; r < d.nefc; ++r) {
    if (!IsElliptic(d, r)) continue;
    other[r] = d.efc_force[r];
    if (!IsNormal(d, r)) continue;
    if (acceleration.empty()) {
      acceleration.resize(d.nefc);
      mj_mulJacVec(&m, &d, acceleration.data(), d.qacc);
    }
    other[r] -= std::max(0.0, d.efc_D[r] * (d.efc_aref[r] - acceleration[r]));
  }
  mj_mulJacTVec(&m, &d, force.data(), other.data());
}

}  // namespace continuum
