#include "binding/cable_doubts.h"

#include <algorithm>

namespace continuum {
namespace {

std::string NameOf(const mjModel& m, int tendon) { return mj_id2name(&m, mjOBJ_TENDON, tendon); }

int DepthOf(const mjModel& m, int site) {
  int depth = 0;
  for (int b = m.site_bodyid[site]; b > 0; b = m.body_parentid[b]) ++depth;
  return depth;
}

bool IsBeyond(const mjModel& m, int body, int base) {
  while (body > base) body = m.body_parentid[body];
  return body == base;
}

void Join(std::string& list, const std::string& what, const char* between) {
  if (!what.empty()) list += (list.empty() ? "" : between) + what;
}

// Whether friction of a cable acts between the bodies from `base` on and all others: a part of the
// cable beyond its first contact leads from one to the other.
bool Passes(const mjModel& m, const Cable& cable, int base) {
  for (int k = 1; k < cable.segments(); ++k) {
    const auto& [near, far] = cable.path[k];
    if (cable.both && k + 1 == cable.segments()) continue;  // it carries the base tension
    if (IsBeyond(m, near.body, base) != IsBeyond(m, far.body, base)) return true;
  }
  return false;
}

// Native sensors of force or torque that a cable passes.
std::string BlindSensors(const mjModel& m, std::span<const Cable> cables) {
  std::string blind;
  for (int s = 0; s < m.nsensor; ++s) {
    if (m.sensor_type[s] != mjSENS_FORCE && m.sensor_type[s] != mjSENS_TORQUE) continue;
    const int base = m.site_bodyid[m.sensor_objid[s]];
    const auto passes = [&](const Cable& cable) { return Passes(m, cable, base); };
    if (std::none_of(cables.begin(), cables.end(), passes)) continue;
    const char* const name = mj_id2name(&m, mjOBJ_SENSOR, s);
    Join(blind, name && *name ? "'" + std::string(name) + "'" : "number " + std::to_string(s),
         ", ");
  }
  return blind;
}

// Tendons whose winch has inertia.
std::string WithArmature(const mjModel& m, std::span<const Cable> cables) {
  std::string tendons;
  for (const Cable& cable : cables) {
    const std::string name = "'" + NameOf(m, cable.tendon) + "'";
    const auto has = [&](int a) { return m.actuator_armature[a] != 0; };
    const bool any =
        m.tendon_armature[cable.tendon] != 0 || std::ranges::any_of(cable.actuators, has);
    if (any && tendons.find(name) == tendons.npos) Join(tendons, name, ", ");
  }
  return tendons;
}

}  // namespace

std::string DoubtsOf(const mjModel& m, const Config& config, std::span<const Cable> cables) {
  std::string outward, doubts;
  for (const Cable& cable : cables) {
    const int begin = m.tendon_adr[cable.tendon], end = begin + m.tendon_num[cable.tendon];
    const bool known = outward.find("'" + NameOf(m, cable.tendon) + "'") != outward.npos;
    if (!known && DepthOf(m, m.wrap_objid[begin]) > DepthOf(m, m.wrap_objid[end - 1]))
      Join(outward, "'" + NameOf(m, cable.tendon) + "'", ", ");
  }
  if (const std::string blind = BlindSensors(m, cables); !blind.empty()) {
    Join(doubts,
         "MuJoCo's sensors of force and torque do not feel the friction of a cable that passes "
         "them, as here " +
             blind + "; a sensor of plugin continuum.wrench does",
         "; ");
  }
  if (const std::string heavy = WithArmature(m, cables); !heavy.empty()) {
    Join(doubts,
         "while a cable speeds up, its friction counts the pull of actuators without what their "
         "armature or that of the tendon takes, as here on " +
             heavy,
         "; ");
  }
  if (!outward.empty() && config.Get("driven").empty()) {
    Join(doubts,
         "it takes the first site as the end that is pulled, which is farther from the world than "
         "the last on " +
             outward + ": say driven=\"last\" or driven=\"first\"",
         "; ");
  }
  return doubts;
}

}  // namespace continuum
