#include "binding/cable_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace continuum {
namespace {

constexpr double kOver = 1.05;  // of the width that MuJoCo draws
constexpr double kTurn = 0.2;   // of a piece on a geom, at most [rad]

using Vector = std::array<double, 3>;

// From the end of one segment over a geom to the beginning of the next: a turn about an axis and a
// way along it.
class Arc {
 public:
  // from, to: tangent points; way: of the cable at the first.
  Arc(const mjModel& m, const mjData& d, int geom, const double* from, const double* to,
      const double* way) {
    const double* const R = d.geom_xmat + 9 * geom;
    centre_ = d.geom_xpos + 3 * geom;
    Vector a, b;
    mju_sub3(a.data(), from, centre_), mju_sub3(b.data(), to, centre_);
    mju_cross(axis_.data(), a.data(), way);
    if (m.geom_type[geom] == mjGEOM_CYLINDER) {
      const Vector z{R[2], R[5], R[8]};
      mju_scl3(axis_.data(), z.data(), std::copysign(1, mju_dot3(axis_.data(), z.data())));
    }
    mju_normalize3(axis_.data());
    begin_ = mju_dot3(a.data(), axis_.data()), end_ = mju_dot3(b.data(), axis_.data());
    mju_addScl3(radial_.data(), a.data(), axis_.data(), -begin_);
    mju_cross(ahead_.data(), axis_.data(), radial_.data());
    angle_ = std::atan2(mju_dot3(b.data(), ahead_.data()), mju_dot3(b.data(), radial_.data()));
    if (angle_ < 0 && angle_ > -1e-6) angle_ = 0;  // touches in a point
    if (angle_ < 0) angle_ += 2 * mjPI;
  }

  int pieces() const { return static_cast<int>(std::ceil(angle_ / kTurn)); }
  Vector At(double share) const {
    Vector x;
    mju_copy3(x.data(), centre_);
    mju_addToScl3(x.data(), axis_.data(), std::lerp(begin_, end_, share));
    mju_addToScl3(x.data(), radial_.data(), std::cos(share * angle_));
    mju_addToScl3(x.data(), ahead_.data(), std::sin(share * angle_));
    return x;
  }

 private:
  const double* centre_;
  Vector axis_, radial_, ahead_;  // radial_ and ahead_: as long as the radius
  double begin_, end_, angle_;
};

class Pen {
 public:
  Pen(const mjModel& m, double red_at, mjvScene& scene) : m_(m), red_at_(red_at), scene_(scene) {}

  void Draw(int tendon, double tension, const double* from, const double* to) {
    if (scene_.ngeom >= scene_.maxgeom) return;
    const float x = static_cast<float>(std::clamp(tension / red_at_, 0.0, 1.0));
    const float rgba[4] = {0.13f + 0.80f * x, 0.40f - 0.25f * x, 0.85f - 0.75f * x, 1};
    mjvGeom* const geom = scene_.geoms + scene_.ngeom++;
    mjv_initGeom(geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, rgba);
    mjv_connector(geom, mjGEOM_CAPSULE, kOver * m_.tendon_width[tendon], from, to);
    geom->objtype = mjOBJ_TENDON;
    geom->objid = tendon;
    geom->category = mjCAT_DECOR;
  }

 private:
  const mjModel& m_;
  double red_at_;
  mjvScene& scene_;
};

}  // namespace

void DrawCables(const mjModel& m, const mjData& d, const std::vector<Cable>& cables,
                const CableGeometry& geometry, std::span<const double> tension, double red_at,
                mjvScene& scene) {
  Pen pen(m, red_at, scene);
  int s = 0;
  for (const Cable& cable : cables) {
    for (int k = 0; k < cable.segments(); ++k, ++s) {
      pen.Draw(cable.tendon, tension[s], geometry.Near(d, s), geometry.Far(d, s));
      const int geom = cable.path[k].far.geom;
      if (geom < 0) continue;
      double way[3];
      geometry.Along(s, way);
      const Arc arc(m, d, geom, geometry.Far(d, s), geometry.Near(d, s + 1), way);
      const int pieces = arc.pieces();
      for (int i = 0; i < pieces; ++i) {
        const double from = double(i) / pieces, to = double(i + 1) / pieces;
        pen.Draw(cable.tendon, std::lerp(tension[s], tension[s + 1], (from + to) / 2),
                 arc.At(from).data(), arc.At(to).data());
      }
    }
  }
}

}  // namespace continuum
