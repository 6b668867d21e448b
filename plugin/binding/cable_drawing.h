#pragma once

#include <span>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/cable.h"
#include "binding/cable_geometry.h"

namespace continuum {

/// Draws cables from blue (slack) to red, over those of MuJoCo. On a geom they fade from one
/// segment to the next. tension: of the segments [N]; red_at: drawn red [N].
void DrawCables(const mjModel& m, const mjData& d, const std::vector<Cable>& cables,
                const CableGeometry& geometry, std::span<const double> tension, double red_at,
                mjvScene& scene);

}  // namespace continuum
