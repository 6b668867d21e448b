#include "binding/tension_row.h"

#include <cmath>

namespace continuum {
namespace {

// d/dx of an equality's polynomial: L_1 − L_1(0) = Σ_k c_k x^k, x = L_2 − L_2(0).
double Slope(const mjModel& m, const mjData& d, int equality) {
  const double* const c = m.eq_data + mjNEQDATA * equality;
  const int other = m.eq_obj2id[equality];
  const double x = other < 0 ? 0 : d.ten_length[other] - m.tendon_length0[other];
  return c[1] + x * (2 * c[2] + x * (3 * c[3] + x * 4 * c[4]));
}

// A limit at the upper end pulls, at the lower end it pushes: the one whose distance the row has.
double LimitSign(const mjModel& m, const mjData& d, int r, int tendon) {
  const double* const range = m.tendon_range + 2 * tendon;
  const double length = d.ten_length[tendon], distance = d.efc_pos[r];
  const bool upper =
      std::abs(range[1] - length - distance) <= std::abs(length - range[0] - distance);
  return upper ? 1 : -1;
}

}  // namespace

double TensionRow::On(int tendon) const {
  for (const Share& share : shares) {
    if (share.tendon == tendon) return share.tension;
  }
  return 0;
}

TensionRows::TensionRows(const mjModel& m, std::span<const Cable> cables) : pulled_(m.ntendon) {
  for (const Cable& cable : cables) {
    pulled_[cable.tendon] = true;
    any_ |= m.tendon_limited[cable.tendon] != 0;
  }
  for (int e = 0; e < m.neq; ++e) {
    if (m.eq_type[e] != mjEQ_TENDON) continue;
    const int first = m.eq_obj1id[e], second = m.eq_obj2id[e];
    any_ |= Pulls(first) || Pulls(second);
  }
}

std::vector<TensionRow> TensionRows::At(const mjModel& m, const mjData& d) const {
  std::vector<TensionRow> rows;
  for (int r = 0; any_ && r < d.nefc; ++r) {
    const int id = d.efc_id[r];
    if (d.efc_type[r] == mjCNSTR_LIMIT_TENDON && Pulls(id)) {
      rows.push_back({r, true, {{id, LimitSign(m, d, r, id)}}});
    }
    if (d.efc_type[r] != mjCNSTR_EQUALITY || m.eq_type[id] != mjEQ_TENDON) continue;
    const int first = m.eq_obj1id[id], second = m.eq_obj2id[id];
    if (!Pulls(first) && !Pulls(second)) continue;
    rows.push_back({r, false, {{first, -1}}});
    if (second >= 0) rows.back().shares.push_back({second, Slope(m, d, id)});
  }
  return rows;
}

}  // namespace continuum
