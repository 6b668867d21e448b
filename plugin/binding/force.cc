#include "binding/force.h"

namespace continuum {

std::vector<Line> LinesOf(const mjModel& m, const Config& config, Joints types) {
  const auto [joints, ids] = config.MatchLines(types);
  std::vector<Line> lines;
  for (const int id : ids) lines.push_back({joints, id, joints ? m.jnt_dofadr[id] : -1});
  return lines;
}

}  // namespace continuum
