#pragma once

#include <array>
#include <vector>

#include "models/twin_pivot/joint.h"
#include "models/twin_pivot/load.h"

namespace continuum::twin_pivot {

/// A vector fixed in the base frame, seen from disc m: v_m = Rx(-+90 deg) Rz(-beta_m) v_m-1.
template <class T>
using Vector = std::array<T, 3>;

template <class T>
Vector<T> IntoNext(const Joint<T>& joint, bool odd, const Vector<T>& v) {
  const T x = joint.cosine * v[0] + joint.sine * v[1];
  const T y = joint.cosine * v[1] - joint.sine * v[0];
  return odd ? Vector<T>{x, v[2], -y} : Vector<T>{x, -v[2], y};
}

/// The reverse: a vector of disc m seen from disc m-1.
template <class T>
Vector<T> IntoPrevious(const Joint<T>& joint, bool odd, const Vector<T>& v) {
  const T y = odd ? -v[2] : v[2];
  const T z = odd ? v[1] : -v[1];
  return {joint.cosine * v[0] - joint.sine * y, joint.sine * v[0] + joint.cosine * y, z};
}

/// z component of a x b.
template <class T>
T CrossZ(const T& ax, const T& ay, const Vector<T>& b) {
  return ax * b[1] - ay * b[0];
}

/// What loads on discs do beyond each joint: their force R and moment M about O_m-1, seen from disc
/// m-1. About another point c of the bending plane the moment has M_z - (c x R)_z (1).
template <class T>
class LoadsBeyond {
 public:
  LoadsBeyond(const std::vector<DiscLoad>& loads, double scale,
              const std::vector<Joint<T>>& joint) {
    if (loads.empty()) return;
    force_.assign(joint.size(), {T(0), T(0), T(0)});
    moment_ = force_;
    Outward(loads, scale, joint);
    Inward(joint);
  }

  /// z component of the moment about (x, y) of the frame of disc m, m from 0.
  T About(int m, const T& x, const T& y) const {
    if (force_.empty()) return T(0);
    return moment_[m][2] - CrossZ(x, y, force_[m]);  // (1)
  }
  bool empty() const { return force_.empty(); }

 private:
  // Every load seen from its own disc: entry m is disc m+1.
  void Outward(const std::vector<DiscLoad>& loads, double scale,
               const std::vector<Joint<T>>& joint) {
    std::array<Vector<T>, 3> axes = {Vector<T>{T(1), T(0), T(0)}, Vector<T>{T(0), T(1), T(0)},
                                     Vector<T>{T(0), T(0), T(1)}};
    for (std::size_t m = 0; m < joint.size(); ++m) {
      for (Vector<T>& axis : axes) axis = IntoNext(joint[m], m % 2 == 0, axis);
      for (const DiscLoad& load : loads) {
        if (load.disc != static_cast<int>(m) + 1) continue;
        for (int i = 0; i < 3; ++i) {
          for (int a = 0; a < 3; ++a) {
            force_[m][i] += scale * load.force[a] * axes[a][i];
            moment_[m][i] += scale * load.moment[a] * axes[a][i];
          }
        }
      }
    }
  }

  void Inward(const std::vector<Joint<T>>& joint) {
    Vector<T> force = {T(0), T(0), T(0)}, moment = force;
    for (int m = static_cast<int>(joint.size()) - 1; m >= 0; --m) {
      for (int i = 0; i < 3; ++i) {
        force[i] += force_[m][i];
        moment[i] += moment_[m][i];
      }
      const Joint<T>& at = joint[m];
      force = IntoPrevious(at, m % 2 == 0, force);
      moment = IntoPrevious(at, m % 2 == 0, moment);
      moment[0] += at.origin.y * force[2];
      moment[1] -= at.origin.x * force[2];
      moment[2] += CrossZ(at.origin.x, at.origin.y, force);
      force_[m] = force;
      moment_[m] = moment;
    }
  }

  std::vector<Vector<T>> force_, moment_;
};

}  // namespace continuum::twin_pivot
