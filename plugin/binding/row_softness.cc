#include "binding/row_softness.h"

#include <algorithm>

namespace continuum {
namespace {

constexpr double kFrictionless = 1e-3;

// Solvers in the dual space have R on the diagonal of a matrix of their own.
void AddToDual(const mjModel& m, mjData& d, int r, double change) {
  if (!d.efc_AR || d.nA == 0) return;
  if (!mj_isSparse(&m)) {
    d.efc_AR[r * (d.nefc + 1)] += change;
    return;
  }
  for (int k = d.efc_AR_rowadr[r]; k < d.efc_AR_rowadr[r] + d.efc_AR_rownnz[r]; ++k) {
    if (d.efc_AR_colind[k] == r) d.efc_AR[k] += change;
  }
}

bool Touches(const mjModel& m, const mjContact& contact, const std::vector<bool>& trees) {
  return std::any_of(contact.geom, contact.geom + 2, [&](int geom) {
    const int tree = geom < 0 ? -1 : m.body_treeid[m.geom_bodyid[geom]];
    return tree >= 0 && trees[tree];
  });
}

}  // namespace

void SetSoftness(const mjModel& m, mjData& d, int r, double R) {
  AddToDual(m, d, r, R - d.efc_R[r]);
  d.efc_R[r] = R, d.efc_D[r] = 1 / R;
  if (d.nisland == 0) return;
  const int i = d.map_efc2iefc[r];
  d.iefc_R[i] = d.efc_R[r], d.iefc_D[i] = d.efc_D[r];
}

void SoftenContacts(const mjModel& m, mjData& d, const std::vector<bool>& trees) {
  for (int c = 0; c < d.ncon; ++c) {
    const mjContact& contact = d.contact[c];
    const int first = contact.efc_address;
    if (first < 0 || d.efc_type[first] != mjCNSTR_CONTACT_PYRAMIDAL) continue;
    if (contact.friction[0] >= kFrictionless || !Touches(m, contact, trees)) continue;
    const double impedance = d.efc_KBIP[4 * first + 2], edges = 2 * (contact.dim - 1);
    const double native = d.efc_diagA[first] * (1 - impedance) / impedance;
    const double normal = native / (2 * contact.mu * contact.mu);
    for (int r = first; r < first + edges; ++r) SetSoftness(m, d, r, edges * normal);
  }
}

}  // namespace continuum
