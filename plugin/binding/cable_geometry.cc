#include "binding/cable_geometry.h"

#include <algorithm>
#include <cmath>

#include "binding/wide.h"

namespace continuum {
namespace {

constexpr double kNothing = 1e-9;  // segments that are shorter have no direction of their own [m]
constexpr double kSmall = 0.01;  // sin²(θ/2) up to which the series of the arcsine is good to 1e-16

// arcsin(√s)/√s.
inline double ArcsineSeries(double s) {
  return 1 + s * (1.0 / 6 +
                  s * (3.0 / 40 +
                       s * (5.0 / 112 +
                            s * (35.0 / 1152 +
                                 s * (63.0 / 2816 + s * (231.0 / 13312 + s * 143.0 / 10240))))));
}

}  // namespace

CableGeometry::CableGeometry(const mjModel& m, std::span<const Cable> cables) : first{0}, begin{0} {
  for (const Cable& cable : cables) {
    for (int k = 0; k < cable.segments(); ++k) {
      const auto& [near, far] = cable.path[k];
      if (near.geom >= 0)
        wraps_.push_back({cable.tendon, near.item, first.back() + k, cable.from_last, false});
      const int wraps = static_cast<int>(wraps_.size());
      near_.push_back(near.site >= 0 ? near.site : ~(2 * wraps - 1));
      far_.push_back(far.site >= 0 ? far.site : ~(2 * wraps));
      for (int l = cable.begin[k]; l < cable.begin[k + 1]; ++l) {
        const JacobianEntry& entry = cable.entries[l];
        dof.push_back(entry.dof), sign_.push_back(entry.sign);
        root_.push_back(m.body_rootid[m.dof_bodyid[entry.dof]]);
      }
      begin.push_back(static_cast<int>(dof.size()));
    }
    first.push_back(static_cast<int>(near_.size()));
    both.push_back(cable.both);
  }
  for (auto* const each : {&theta, &slip, &x_, &y_, &z_, &half_}) each->assign(segments(), 0);
  arm.assign(entries(), 0);
  tangent_.assign(6 * wraps_.size(), 0);
}

void CableGeometry::Update(const mjModel& m, const mjData& d) {
  if (!wraps_.empty()) FindTangents(m, d);
  Directions(d);
  Angles();
  for (const Wrap& wrap : wraps_) theta[wrap.segment] = WrapAngle(m, d, wrap);
  Arms(d);
}

// MuJoCo lists the points of a path: one of a site or a pulley, two of a geom that is touched.
void CableGeometry::FindTangents(const mjModel& m, const mjData& d) {
  for (std::size_t w = 0; w < wraps_.size(); ++w) {
    Wrap& wrap = wraps_[w];
    double* const to = tangent_.data() + 6 * w;
    int point = d.ten_wrapadr[wrap.tendon];
    const int end = point + d.ten_wrapnum[wrap.tendon];
    for (int item = m.tendon_adr[wrap.tendon]; item < wrap.item; ++item) {
      const bool geom = m.wrap_type[item] == mjWRAP_SPHERE || m.wrap_type[item] == mjWRAP_CYLINDER;
      point += !geom ? 1 : point < end && d.wrap_obj[point] == m.wrap_objid[item] ? 2 : 0;
    }
    wrap.touches = point + 1 < end && d.wrap_obj[point] == m.wrap_objid[wrap.item];
    if (!wrap.touches) {
      Miss(m, d, wrap, to);
      continue;
    }
    const double* const from = d.wrap_xpos + 3 * point;
    mju_copy3(to, from + (wrap.reversed ? 3 : 0));
    mju_copy3(to + 3, from + (wrap.reversed ? 0 : 3));
  }
}

// Both points are the one of the straight line that is nearest to the sphere's centre or the
// cylinder's axis, but between the sites.
void CableGeometry::Miss(const mjModel& m, const mjData& d, const Wrap& wrap,
                         double* tangents) const {
  const int geom = m.wrap_objid[wrap.item];
  const double *const a = At(d, near_[wrap.segment - 1]), *const b = At(d, far_[wrap.segment]);
  double line[3], to[3], across[3];
  mju_sub3(line, b, a);
  mju_sub3(to, d.geom_xpos + 3 * geom, a);
  mju_copy3(across, line);
  if (m.wrap_type[wrap.item] == mjWRAP_CYLINDER) {
    const double* const R = d.geom_xmat + 9 * geom;
    const double axis[3] = {R[2], R[5], R[8]};
    mju_addToScl3(across, axis, -mju_dot3(across, axis));
  }
  const double length = mju_dot3(across, across);
  const double share = length > 0 ? std::clamp(mju_dot3(to, across) / length, 0.01, 0.99) : 0.5;
  for (int i = 0; i < 3; ++i) tangents[i] = tangents[3 + i] = a[i] + share * line[i];
}

// (1)
double CableGeometry::WrapAngle(const mjModel& m, const mjData& d, const Wrap& wrap) const {
  const int geom = m.wrap_objid[wrap.item], s = wrap.segment;
  if (!wrap.touches) return 0;
  const double *const p = At(d, far_[s - 1]), *const q = At(d, near_[s]);
  double along[3], from[3], to[3], gap[3], turn[3];
  Along(s - 1, along);
  mju_sub3(gap, q, p);
  if (mju_norm3(gap) <= 1e-9 * m.geom_size[3 * geom]) return theta[s];  // a bend, no arc
  mju_sub3(from, p, d.geom_xpos + 3 * geom);
  mju_sub3(to, q, d.geom_xpos + 3 * geom);
  double pitch = 0;  // sin α
  if (m.wrap_type[wrap.item] == mjWRAP_CYLINDER) {
    const double* const R = d.geom_xmat + 9 * geom;
    const double axis[3] = {R[2], R[5], R[8]};
    pitch = mju_dot3(along, axis);
    for (double* const v : {from, to, along}) mju_addToScl3(v, axis, -mju_dot3(v, axis));
  }
  mju_cross(turn, from, along);  // about this axis the path turns
  mju_normalize3(turn);
  double beside[3];
  mju_cross(beside, turn, from);
  const double arc = std::atan2(mju_dot3(to, beside), mju_dot3(to, from));
  return (arc < -1e-6 ? arc + 2 * mjPI : std::max(0.0, arc)) *
         std::sqrt(std::max(0.0, 1 - pitch * pitch));
}

// Loops without branches, here and below: the compiler then works on several numbers at once.
CONTINUUM_WIDE void CableGeometry::Directions(const mjData& d) {
  const int n = segments();
  double *const x = x_.data(), *const y = y_.data(), *const z = z_.data(), *const l = half_.data();
  int without = 0;
  for (int s = 0; s < n; ++s) {
    const double *const p = At(d, near_[s]), *const q = At(d, far_[s]);
    x[s] = q[0] - p[0], y[s] = q[1] - p[1], z[s] = q[2] - p[2];
    l[s] = x[s] * x[s] + y[s] * y[s] + z[s] * z[s];
    const bool none = l[s] <= kNothing * kNothing;
    without += none;
    if (none) x[s] = l[s] = 1, y[s] = z[s] = 0;
  }
  for (int s = 0; s < n; ++s) {
    const double scale = 1 / std::sqrt(l[s]);
    x[s] *= scale, y[s] *= scale, z[s] *= scale;
  }
  for (int c = 0; without > 0 && c < cables(); ++c) FillDirections(d, c);
}

// Where sites coincide the cable goes on as before: the whole angle is at one of them.
void CableGeometry::FillDirections(const mjData& d, int c) {
  int known = -1;
  for (int s = first[c]; s < first[c + 1]; ++s) {
    const double *const p = At(d, near_[s]), *const q = At(d, far_[s]);
    const bool none = mju_dist3(p, q) <= kNothing;
    if (none && known >= 0) x_[s] = x_[known], y_[s] = y_[known], z_[s] = z_[known];
    for (int k = first[c]; !none && known < 0 && k < s; ++k)
      x_[k] = x_[s], y_[k] = y_[s], z_[k] = z_[s];
    if (!none) known = s;
  }
}

// The angle between two unit vectors a and b by sin²(θ/2) = |b − a|²/4.
CONTINUUM_WIDE void CableGeometry::Angles() {
  const int n = segments();
  const double *const x = x_.data(), *const y = y_.data(), *const z = z_.data();
  double *const half = half_.data(), *const angle = theta.data();
  for (int s = 1; s < n; ++s) {
    const double a = x[s] - x[s - 1], b = y[s] - y[s - 1], c = z[s] - z[s - 1];
    half[s] = 0.25 * (a * a + b * b + c * c);
  }
  for (int c = 0; c < cables(); ++c) half[first[c]] = 0;
  for (int s = 0; s < n; ++s) angle[s] = 2 * std::sqrt(half[s]) * ArcsineSeries(half[s]);
  for (int s = 0; s < n; ++s) {
    if (half[s] > kSmall) angle[s] = 2 * std::atan2(std::sqrt(half[s]), HalfCosine(s));
  }
}

// cos(θ/2) = |a + b|/2: no less exact where a cable turns back.
double CableGeometry::HalfCosine(int s) const {
  const double x = x_[s] + x_[s - 1], y = y_[s] + y_[s - 1], z = z_[s] + z_[s - 1];
  return 0.5 * std::sqrt(x * x + y * y + z * z);
}

// cdof: rotation and translation at the tree's centre of mass o.
void CableGeometry::Arms(const mjData& d) {
  double line[6] = {};  // moment of the direction about o, and the direction
  for (int s = 0; s < segments(); ++s) {
    const double* const p = At(d, far_[s]);
    line[3] = x_[s], line[4] = y_[s], line[5] = z_[s];
    double rate = 0;
    for (int l = begin[s], root = -1; l < begin[s + 1]; ++l) {
      if (root != root_[l]) {
        root = root_[l];
        const double* const o = d.subtree_com + 3 * root;
        const double x = p[0] - o[0], y = p[1] - o[1], z = p[2] - o[2];
        line[0] = y * line[5] - z * line[4];
        line[1] = z * line[3] - x * line[5];
        line[2] = x * line[4] - y * line[3];
      }
      const double* const c = d.cdof + 6 * dof[l];
      const double even = c[0] * line[0] + c[2] * line[2] + c[4] * line[4],
                   odd = c[1] * line[1] + c[3] * line[3] + c[5] * line[5];
      arm[l] = sign_[l] * (even + odd);
      rate += arm[l] * d.qvel[dof[l]];
    }
    slip[s] = -rate;
  }
  for (int c = 0; c < cables(); ++c) {
    for (int s = first[c + 1] - 1; s-- > first[c];) slip[s] += slip[s + 1];
  }
}

}  // namespace continuum
