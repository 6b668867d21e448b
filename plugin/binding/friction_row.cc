#include "binding/friction_row.h"

namespace continuum {

std::vector<FrictionRow> FrictionRowsOf(const mjModel& m, const Config& config, Joints types) {
  const auto [joints, ids] = config.MatchLines(types);
  std::vector<FrictionRow> rows;
  for (const int id : ids) {
    const bool ball = joints && m.jnt_type[id] == mjJNT_BALL;
    const int index = joints ? m.jnt_dofadr[id] : id;
    for (int k = 0; k < (ball ? 3 : 1); ++k) {
      rows.push_back({joints, id, index + k, ball ? k : -1, true, true});
    }
  }
  return rows;
}

}  // namespace continuum
