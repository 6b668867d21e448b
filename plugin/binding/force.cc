#include "binding/force.h"

namespace continuum {

std::vector<Line> MatchLines(const mjModel& m, const Config& config) {
  const bool joints = !config.Get("joint").empty(), tendons = !config.Get("tendon").empty();
  if (joints == tendons) {
    throw Error::Input(config.Who(), "one of the keys 'joint' and 'tendon'",
                       joints ? "both" : "none");
  }
  std::vector<Line> lines;
  for (const int id :
       config.Match(joints ? "joint" : "tendon", joints ? mjOBJ_JOINT : mjOBJ_TENDON)) {
    if (joints && m.jnt_type[id] != mjJNT_HINGE && m.jnt_type[id] != mjJNT_SLIDE) {
      throw Error::Input(config.Who() + ": joint '" + mj_id2name(&m, mjOBJ_JOINT, id) + "'",
                         "a hinge or slide joint", "another type");
    }
    lines.push_back({joints, id, joints ? m.jnt_dofadr[id] : -1});
  }
  return lines;
}

}  // namespace continuum
