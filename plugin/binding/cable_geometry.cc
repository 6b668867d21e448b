#include "binding/cable_geometry.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

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
      near_.push_back(cable.sites[k]), far_.push_back(cable.sites[k + 1]);
      for (int l = cable.begin[k]; l < cable.begin[k + 1]; ++l) {
        const JacobianEntry& entry = cable.entries[l];
        dof.push_back(entry.dof), sign_.push_back(entry.sign);
        root_.push_back(m.body_rootid[m.dof_bodyid[entry.dof]]);
      }
      begin.push_back(static_cast<int>(dof.size()));
    }
    first.push_back(static_cast<int>(near_.size()));
  }
  for (auto* const each : {&theta, &slip, &x_, &y_, &z_, &half_}) each->assign(segments(), 0);
  arm.assign(entries(), 0);
}

void CableGeometry::Update(const mjData& d) {
  Directions(d);
  Angles();
  Arms(d);
}

// Loops without branches, here and below: the compiler then works on several numbers at once.
void CableGeometry::Directions(const mjData& d) {
  const int n = segments();
  double *const x = x_.data(), *const y = y_.data(), *const z = z_.data(), *const l = half_.data();
  for (int s = 0; s < n; ++s) {
    const double *const p = d.site_xpos + 3 * near_[s], *const q = d.site_xpos + 3 * far_[s];
    x[s] = q[0] - p[0], y[s] = q[1] - p[1], z[s] = q[2] - p[2];
    l[s] = x[s] * x[s] + y[s] * y[s] + z[s] * z[s];
    if (l[s] <= mjMINVAL * mjMINVAL) x[s] = l[s] = 1, y[s] = z[s] = 0;
  }
  for (int s = 0; s < n; ++s) {
    const double scale = 1 / std::sqrt(l[s]);
    x[s] *= scale, y[s] *= scale, z[s] *= scale;
  }
}

// The angle between two unit vectors a and b by sin²(θ/2) = |b − a|²/4.
void CableGeometry::Angles() {
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
    const double* const p = d.site_xpos + 3 * far_[s];
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
