#include "binding/cable.h"

#include "binding/actuator_force.h"
#include "error.h"

namespace continuum {
namespace {

// Degrees of freedom that move one of two bodies only.
void AddEntries(const mjModel& m, int near, int far, std::vector<JacobianEntry>& entries) {
  while (near != far) {
    const bool outer = far > near;  // the higher index is no ancestor of the other
    int& body = outer ? far : near;
    for (int dof = m.body_dofadr[body]; dof < m.body_dofadr[body] + m.body_dofnum[body]; ++dof) {
      entries.push_back({dof, outer ? 1.0 : -1.0});
    }
    body = m.body_parentid[body];
  }
}

}  // namespace

Cable MakeCable(const mjModel& m, int tendon, const std::string& who) {
  const std::string where = who + ": tendon '" + mj_id2name(&m, mjOBJ_TENDON, tendon) + "'";
  Cable cable{tendon, {}, {}, {}, {0}};
  for (int w = m.tendon_adr[tendon]; w < m.tendon_adr[tendon] + m.tendon_num[tendon]; ++w) {
    if (m.wrap_type[w] != mjWRAP_SITE) {
      throw Error::Input(where, "a spatial tendon through sites only",
                         m.wrap_type[w] == mjWRAP_JOINT ? "a fixed tendon" : "a pulley or a geom");
    }
    cable.sites.push_back(m.wrap_objid[w]);
  }
  if (cable.sites.size() < 3) {
    throw Error::Input(where, "a contact, which is a site between two others",
                       std::to_string(cable.sites.size()) + " sites");
  }
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_trntype[a] == mjTRN_TENDON && m.actuator_trnid[2 * a] == tendon) {
      cable.actuators.push_back(a);
    }
  }
  for (int k = 0; k < cable.segments(); ++k) {
    AddEntries(m, m.site_bodyid[cable.sites[k]], m.site_bodyid[cable.sites[k + 1]], cable.entries);
    cable.begin.push_back(static_cast<int>(cable.entries.size()));
  }
  return cable;
}

double BaseTension(const mjModel& m, const mjData& d, const Cable& cable) {
  double pull = 0;
  for (const int a : cable.actuators) {
    pull -= m.actuator_gear[6 * m.actuator_outadr[a]] * LimitedForce(m, d, a);
  }
  return pull;
}

}  // namespace continuum
