#include "binding/path.h"

namespace continuum {

std::vector<Cable> MatchCables(const mjModel& m, const Config& config) {
  std::vector<Cable> cables;
  for (const int t : config.Match("tendon", mjOBJ_TENDON)) {
    cables.push_back(MakeCable(m, t, config.Who()));
  }
  return cables;
}

void DrawCables(const mjModel& m, const mjData& d, std::span<const Cable> cables,
                std::span<const double> tension, double full, mjvScene& scene) {
  std::size_t s = 0;
  for (const Cable& cable : cables) {
    const double width = 1.05 * m.tendon_width[cable.tendon];
    for (int k = 0; k < cable.segments(); ++k, ++s) {
      if (scene.ngeom >= scene.maxgeom) return;
      const float x = static_cast<float>(std::clamp(tension[s] / full, 0.0, 1.0));
      const float rgba[4] = {0.13f + 0.80f * x, 0.40f - 0.25f * x, 0.85f - 0.75f * x, 1};
      mjvGeom* const geom = scene.geoms + scene.ngeom++;
      mjv_initGeom(geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, rgba);
      mjv_connector(geom, mjGEOM_CAPSULE, width, d.site_xpos + 3 * cable.sites[k],
                    d.site_xpos + 3 * cable.sites[k + 1]);
      geom->objtype = mjOBJ_TENDON;
      geom->objid = cable.tendon;
      geom->category = mjCAT_DECOR;
    }
  }
}

}  // namespace continuum
