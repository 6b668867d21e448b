#include "sim/film/camera_framing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace continuum {
namespace {

using Vector = Framing::Vector;
using Box = Framing::Box;

Vector At(const mjtNum* p) { return {p[0], p[1], p[2]}; }
double Dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bool Moves(const mjModel& m, int body) { return m.body_weldid[body] != 0; }

// The box of a geom, an object of half sizes h turned by R: half sizes |R| h.
Box BoxOfGeom(const mjModel& m, const mjData& d, int g) {
  const mjtNum* const r = d.geom_xmat + 9 * g;
  const mjtNum* const local = m.geom_aabb + 6 * g;  // center, half sizes
  Vector center = At(d.geom_xpos + 3 * g), half{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      center[i] += r[3 * i + j] * local[j];
      half[i] += std::abs(r[3 * i + j]) * local[3 + j];
    }
  }
  Box box;
  box.Add(center, half);
  return box;
}

}  // namespace

Framing::Box::Box() {
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
}

void Framing::Box::Add(const Vector& p, const Vector& half) {
  for (int i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], p[i] - half[i]);
    high[i] = std::max(high[i], p[i] + half[i]);
  }
}

void Framing::Box::Add(const Box& other) {
  if (other.Empty()) return;
  Add(other.low);
  Add(other.high);
}

Vector Framing::Box::Center() const {
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

double Framing::Box::Radius() const {
  return Empty() ? 0 : std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2;
}

Vector Framing::Box::Corner(int k) const {
  return {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]};
}

void Framing::Include(const mjModel& m, const mjData& d) {
  mjvOption option;
  mjv_defaultOption(&option);
  std::vector<Box> fixed;
  for (int g = 0; g < m.ngeom; ++g) {
    const bool visible = option.geomgroup[m.geom_group[g]] && m.geom_rgba[4 * g + 3] > 0;
    if (!visible || m.geom_type[g] == mjGEOM_PLANE) continue;
    const Box box = BoxOfGeom(m, d, g);
    if (Moves(m, m.geom_bodyid[g]))
      moving_.Add(box);
    else
      fixed.push_back(box);
  }
  for (int s = 0; s < m.nsite; ++s) {
    if (Moves(m, m.site_bodyid[s])) moving_.Add(At(d.site_xpos + 3 * s));
  }
  for (int t = 0; t < m.ntendon; ++t) {
    for (int k = 0; k < d.ten_wrapnum[t]; ++k) {
      moving_.Add(At(d.wrap_xpos + 3 * (d.ten_wrapadr[t] + k)));
    }
  }
  shown_.Add(moving_);
  for (const Box& box : fixed) {
    if (Near(box)) shown_.Add(box);
  }
}

void Framing::Include(const Framing& other) {
  moving_.Add(other.moving_);
  shown_.Add(other.shown_);
}

void Framing::Aim(mjvCamera& camera, double fovy, double aspect) {
  if (shown_.Empty()) return;
  constexpr double kFill = 0.84;  // leaves a strip for text above and below
  const double deg = std::numbers::pi / 180;
  const double ca = std::cos(camera.azimuth * deg), sa = std::sin(camera.azimuth * deg);
  const double ce = std::cos(camera.elevation * deg), se = std::sin(camera.elevation * deg);
  const Vector forward = {ca * ce, sa * ce, se}, up = {-ca * se, -sa * se, ce};
  const Vector right = {sa, -ca, 0};
  const double slope = kFill * std::tan(fovy * deg / 2);
  const Vector center = shown_.Center();
  const double radius = std::max(shown_.Radius(), 1e-6);
  camera.distance = 1.2 * radius;
  for (int k = 0; k < 8; ++k) {
    Vector q = shown_.Corner(k);
    for (int i = 0; i < 3; ++i) q[i] -= center[i];
    const double off = std::max(std::abs(Dot(q, up)), std::abs(Dot(q, right)) / aspect);
    camera.distance = std::max(camera.distance, off / slope - Dot(q, forward));
  }
  std::copy(center.begin(), center.end(), camera.lookat);
  nearest_ = camera.distance - radius;
  farthest_ = camera.distance + radius;
}

void Framing::KeepFromClipping(mjvScene& scene) const {
  if (shown_.Empty()) return;
  for (mjvGLCamera& eye : scene.camera) {
    const float near = std::min(eye.frustum_near, static_cast<float>(0.5 * nearest_));
    const float scale = near / eye.frustum_near;
    for (float* side : {&eye.frustum_center, &eye.frustum_width, &eye.frustum_bottom,
                        &eye.frustum_top, &eye.frustum_near}) {
      *side *= scale;
    }
    eye.frustum_far = std::max(eye.frustum_far, static_cast<float>(2 * farthest_));
  }
}

// Within the reach of the robot: its base and what it may touch, not the room around it.
bool Framing::Near(const Box& box) const {
  if (moving_.Empty()) return true;
  const Vector a = box.Center(), b = moving_.Center();
  const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  return distance + box.Radius() <= 2.5 * moving_.Radius();
}

}  // namespace continuum
