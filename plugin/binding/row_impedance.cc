#include "binding/row_impedance.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

struct Parameters {
  const double *solref, *solimp;
};

Parameters ParametersOf(const mjModel& m, const mjData& d, int row) {
  const int id = d.efc_id[row];
  if (m.opt.enableflags & mjENBL_OVERRIDE && row >= d.ne + d.nf + d.nl)
    return {m.opt.o_solref, m.opt.o_solimp};
  if (d.efc_type[row] == mjCNSTR_EQUALITY)
    return {m.eq_solref + mjNREF * id, m.eq_solimp + mjNIMP * id};
  if (d.efc_type[row] == mjCNSTR_LIMIT_TENDON)
    return {m.tendon_solref_lim + mjNREF * id, m.tendon_solimp_lim + mjNIMP * id};
  return {d.contact[id].solref, d.contact[id].solimp};
}

// Between least and most, by the penetration over the width.
double Impedance(const double* solimp, double depth) {
  const auto within = [](double x) { return std::clamp(x, mjMINIMP, mjMAXIMP); };
  const double least = within(solimp[0]), most = within(solimp[1]), width = solimp[2],
               middle = within(solimp[3]), power = std::max(1.0, solimp[4]);
  if (least == most || width <= mjMINVAL) return 0.5 * (least + most);
  const double x = std::min(1.0, std::abs(depth) / width);
  const double y = x <= middle ? std::pow(x, power) / std::pow(middle, power - 1)
                               : 1 - std::pow(1 - x, power) / std::pow(1 - middle, power - 1);
  return least + y * (most - least);
}

}  // namespace

RowImpedance RowImpedanceOf(const mjModel& m, const mjData& d, int row) {
  const auto [solref, solimp] = ParametersOf(m, d, row);
  const double value = Impedance(solimp, d.efc_pos[row] - d.efc_margin[row]);
  const double most = std::clamp(solimp[1], mjMINIMP, mjMAXIMP);
  if (solref[0] <= 0) return {-solref[0] / (most * most), -solref[1] / most, value};
  const bool safe = !(m.opt.disableflags & mjDSBL_REFSAFE);
  const double time = safe ? std::max(solref[0], 2 * m.opt.timestep) : solref[0];
  const double k = most * time * solref[1];
  return {1 / std::max(mjMINVAL, k * k), 2 / std::max(mjMINVAL, most * time), value};
}

}  // namespace continuum
