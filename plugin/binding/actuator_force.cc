#include "binding/actuator_force.h"

#include <algorithm>

namespace continuum {

double TendonShare(const mjModel& m, const mjData& d, int tendon) {
  if (!m.tendon_actfrclimited[tendon]) return 1;
  double sum = 0;
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_trntype[a] == mjTRN_TENDON && m.actuator_trnid[2 * a] == tendon) {
      sum += d.actuator_force[m.actuator_outadr[a]];
    }
  }
  const double* const range = m.tendon_actfrcrange + 2 * tendon;
  return sum < range[0] ? range[0] / sum : sum > range[1] ? range[1] / sum : 1;
}

double LimitedForce(const mjModel& m, const mjData& d, int actuator, int output) {
  double force = d.actuator_force[m.actuator_outadr[actuator] + output];
  if (m.actuator_trntype[actuator] == mjTRN_TENDON) {
    force *= TendonShare(m, d, m.actuator_trnid[2 * actuator]);
  }
  if (!m.actuator_forcelimited[actuator]) return force;
  const double* const range = m.actuator_forcerange + 2 * actuator;
  return std::clamp(force, range[0], range[1]);
}

}  // namespace continuum
