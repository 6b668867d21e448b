#include "identification/candidates/present_friction.h"

#include <algorithm>
#include <set>

#include "binding/config.h"

namespace continuum {
namespace {

// The objects at a place on which an instance acts; none where it acts on others.
std::set<std::string> ObjectsOf(const mjModel& m, int instance, Place place) {
  std::set<std::string> names;
  const Config config(m, instance);
  if (config.Get(PlaceName(place)).empty()) return names;
  for (const int id : config.Match(place)) {
    if (place == Place::kJoint && m.jnt_type[id] == mjJNT_FREE) continue;  // globs leave it out
    names.insert(mj_id2name(&m, ObjectType(place), id));
  }
  return names;
}

}  // namespace

PresentFriction PresentFrictionOn(const mjModel& m, Place place,
                                  const std::vector<std::string>& names) {
  const std::set<std::string> wanted(names.begin(), names.end());
  PresentFriction found;
  for (int i = 0; i < m.nplugin; ++i) {
    const EffectInfo* const effect = EffectOf(m, i);
    if (!effect || effect->kind != EffectInfo::Kind::kFriction) continue;
    const std::set<std::string> on = ObjectsOf(m, i, place);
    if (std::none_of(on.begin(), on.end(), [&](const auto& n) { return wanted.contains(n); }))
      continue;
    const char* const name = mj_id2name(&m, mjOBJ_PLUGIN, i);
    found = {effect, name ? name : "", on == wanted};
  }
  return found;
}

}  // namespace continuum
