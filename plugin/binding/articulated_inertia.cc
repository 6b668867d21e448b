#include "binding/articulated_inertia.h"

#include <algorithm>

#include "binding/wide.h"

namespace continuum {
namespace {

// The joint that a body moves with; −1: none of these trees.
int LastDof(const mjModel& m, int body) {
  while (body > 0 && m.body_dofnum[body] == 0) body = m.body_parentid[body];
  return body > 0 ? m.body_dofadr[body] + m.body_dofnum[body] - 1 : -1;
}

// I += the inertia of a body: c as MuJoCo keeps it, three moments, three products, mass times
// place, mass.
inline void AddBody(const double* c, double* I, int row) {
  I[0] += c[0], I[1] += c[3], I[2] += c[4], I[4] -= c[8], I[5] += c[7];
  I += row;
  I[0] += c[3], I[1] += c[1], I[2] += c[5], I[3] += c[8], I[5] -= c[6];
  I += row;
  I[0] += c[4], I[1] += c[5], I[2] += c[2], I[3] -= c[7], I[4] += c[6];
  I += row;
  I[1] += c[8], I[2] -= c[7], I[3] += c[9];
  I += row;
  I[0] -= c[8], I[2] += c[6], I[4] += c[9];
  I += row;
  I[0] += c[7], I[1] -= c[6], I[5] += c[9];
}

}  // namespace

bool ArticulatedInertia::Covers(const mjModel& m) {
  const auto none = [](double armature) { return armature == 0; };
  return std::all_of(m.tendon_armature, m.tendon_armature + m.ntendon, none) &&
         std::all_of(m.actuator_armature, m.actuator_armature + m.nactuator, none);
}

ArticulatedInertia::ArticulatedInertia(const mjModel& m, std::span<const int> dofs) {
  std::vector<int> place(m.nv, -1);
  for (const int dof : dofs) {
    place[dof] = static_cast<int>(joints_.size());
    const int parent = m.dof_parentid[dof];
    joints_.push_back({dof, parent < 0 ? -1 : place[parent], {}, {}, 0});
  }
  for (int b = 1; b < m.nbody; ++b) {
    const int dof = LastDof(m, b);
    if (dof >= 0 && place[dof] >= 0) bodies_.push_back({b, place[dof]});
  }
  inertia_.resize(joints_.size() * 6 * kRow);
  motion_.resize(joints_.size() * 4 * 6);
}

// (1)
CONTINUUM_WIDE void ArticulatedInertia::Update(const mjModel& m, const mjData& d,
                                               std::span<const double> damping) {
  std::fill(inertia_.begin(), inertia_.end(), 0.0);
  for (const Body& body : bodies_) AddBody(d.cinert + 10 * body.id, inertia(body.joint), kRow);
  for (int k = static_cast<int>(joints_.size()); k-- > 0;) {
    Joint& joint = joints_[k];
    const double* const s = d.cdof + 6 * joint.dof;
    const double* const I = inertia(k);
    Four front = {}, back = {};
    for (int i = 0; i < 6; ++i) {
      front += s[i] * FourAt(I + i * kRow).v, back += s[i] * FourAt(I + i * kRow + 4).v;
    }
    FourAt(joint.load).v = front, FourAt(joint.load + 4).v = back;
    double own = m.dof_armature[joint.dof] + damping[joint.dof];
    for (int i = 0; i < 6; ++i) own += s[i] * joint.load[i], joint.axis[i] = s[i];
    joint.inverse = 1 / own;
    if (joint.parent < 0) continue;
    double* const to = inertia(joint.parent);
    for (int i = 0; i < 6; ++i) {
      const double f = joint.load[i] * joint.inverse;
      FourAt(to + i * kRow).v += FourAt(I + i * kRow).v - f * front;
      FourAt(to + i * kRow + 4).v += FourAt(I + i * kRow + 4).v - f * back;
    }
  }
}

// (2) and (3)
CONTINUUM_WIDE void ArticulatedInertia::Solve(double* b) {
  const auto n = static_cast<int>(joints_.size());
  std::fill_n(motion_.data(), kRow * n, 0.0);
  for (int k = n; k-- > 0;) {
    const Joint& joint = joints_[k];
    const double* const p = motion_.data() + kRow * k;
    const double even = joint.axis[0] * p[0] + joint.axis[2] * p[2] + joint.axis[4] * p[4],
                 odd = joint.axis[1] * p[1] + joint.axis[3] * p[3] + joint.axis[5] * p[5];
    b[k] -= even + odd;
    if (joint.parent < 0) continue;
    double* const to = motion_.data() + kRow * joint.parent;
    const double f = b[k] * joint.inverse;
    FourAt(to).v += FourAt(p).v + f * FourAt(joint.load).v;
    FourAt(to + 4).v += FourAt(p + 4).v + f * FourAt(joint.load + 4).v;
  }
  static constexpr double kStill[kRow] = {};
  for (int k = 0; k < n; ++k) {
    const Joint& joint = joints_[k];
    const double* const a = joint.parent < 0 ? kStill : motion_.data() + kRow * joint.parent;
    const double even = joint.load[0] * a[0] + joint.load[2] * a[2] + joint.load[4] * a[4],
                 odd = joint.load[1] * a[1] + joint.load[3] * a[3] + joint.load[5] * a[5];
    b[k] = (b[k] - (even + odd)) * joint.inverse;
    double* const to = motion_.data() + kRow * k;
    FourAt(to).v = FourAt(a).v + b[k] * FourAt(joint.axis).v;
    FourAt(to + 4).v = FourAt(a + 4).v + b[k] * FourAt(joint.axis + 4).v;
  }
}

CONTINUUM_WIDE void ArticulatedInertia::SolveFour(double* b) {
  const auto n = static_cast<int>(joints_.size());
  std::fill(motion_.begin(), motion_.end(), 0.0);
  for (int k = n; k-- > 0;) {
    const Joint& joint = joints_[k];
    const double* const p = motion_.data() + 24 * k;
    Four even = FourAt(b + 4 * k).v, odd = {};
    for (int i = 0; i < 6; i += 2) {
      even -= joint.axis[i] * FourAt(p + 4 * i).v,
          odd += joint.axis[i + 1] * FourAt(p + 4 * i + 4).v;
    }
    FourAt(b + 4 * k).v = even -= odd;
    if (joint.parent < 0) continue;
    double* const to = motion_.data() + 24 * joint.parent;
    const Four f = even * joint.inverse;
    for (int i = 0; i < 6; ++i) FourAt(to + 4 * i).v += FourAt(p + 4 * i).v + joint.load[i] * f;
  }
  static constexpr double kStill[24] = {};
  for (int k = 0; k < n; ++k) {
    const Joint& joint = joints_[k];
    const double* const a = joint.parent < 0 ? kStill : motion_.data() + 24 * joint.parent;
    Four even = FourAt(b + 4 * k).v, odd = {};
    for (int i = 0; i < 6; i += 2) {
      even -= joint.load[i] * FourAt(a + 4 * i).v,
          odd += joint.load[i + 1] * FourAt(a + 4 * i + 4).v;
    }
    const Four x = (even - odd) * joint.inverse;
    FourAt(b + 4 * k).v = x;
    double* const to = motion_.data() + 24 * k;
    for (int i = 0; i < 6; ++i) FourAt(to + 4 * i).v = FourAt(a + 4 * i).v + joint.axis[i] * x;
  }
}

}  // namespace continuum
