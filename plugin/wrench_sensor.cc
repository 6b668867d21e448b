#include "wrench_sensor.h"

#include "binding/config.h"

namespace continuum {
namespace {

LawFinder find_law = nullptr;

// Force and torque [6] between the body of a site and its parent, in the axes of the site, with
// MuJoCo's sign: what its sensors say, less what our laws do to points of the body and of those
// beyond it.
void SenseWrench(const mjModel& m, mjData& d, int site, double* out) {
  const int base = m.site_bodyid[site];
  const double *const at = d.site_xpos + 3 * site, *const axes = d.site_xmat + 9 * site;
  double native[6], force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
  mju_transformSpatial(native, d.cfrc_int + 6 * base, 1, at,
                       d.subtree_com + 3 * m.body_rootid[base], axes);
  const auto take = [&](int body, const double* point, const double* f) {
    while (body > base) body = m.body_parentid[body];
    if (body != base) return;
    double arm[3], moment[3];
    mju_sub3(arm, point, at);
    mju_cross(moment, arm, f);
    mju_addTo3(force, f), mju_addTo3(torque, moment);
  };
  for (int i = 0; i < m.nplugin; ++i) {
    if (const BoundLaw* const law = find_law(m, d, i)) law->PointForces(m, d, take);
  }
  double local[6];
  mju_mulMatTVec3(local, axes, force), mju_mulMatTVec3(local + 3, axes, torque);
  mju_sub3(out, native + 3, local), mju_sub3(out + 3, native, local + 3);
}

int InitWrench(const mjModel& m, int i) {
  for (int s = 0; s < m.nsensor; ++s) {
    if (m.sensor_type[s] != mjSENS_PLUGIN || m.sensor_plugin[s] != i) continue;
    if (m.sensor_objtype[s] == mjOBJ_SITE) continue;
    mju_warning("%s: its sensor %d: expected objtype=\"site\"", kWrenchPlugin.data(), s);
    return -1;
  }
  return 0;
}

}  // namespace

void RegisterWrench(LawFinder law_of) {
  find_law = law_of;
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = kWrenchPlugin.data();
  plugin.capabilityflags = mjPLUGIN_SENSOR;
  plugin.needstage = mjSTAGE_ACC;
  plugin.nstate = +[](const mjModel*, int) noexcept { return 0; };
  plugin.nsensordata = +[](const mjModel*, int, int) noexcept { return 6; };
  plugin.init = +[](const mjModel* m, mjData*, int i) noexcept { return InitWrench(*m, i); };
  plugin.reset = +[](const mjModel*, mjtNum*, void*, int) noexcept {};
  plugin.compute = +[](const mjModel* m, mjData* d, int i, int) noexcept {
    for (int s = 0; s < m->nsensor; ++s) {
      if (m->sensor_type[s] == mjSENS_PLUGIN && m->sensor_plugin[s] == i)
        SenseWrench(*m, *d, m->sensor_objid[s], d->sensordata + m->sensor_adr[s]);
    }
  };
  mjp_registerPlugin(&plugin);
}

}  // namespace continuum
