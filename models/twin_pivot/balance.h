#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "models/statics/slide.h"
#include "models/twin_pivot/disc_loads.h"
#include "models/twin_pivot/joint.h"
#include "models/twin_pivot/load.h"
#include "models/twin_pivot/robot.h"

namespace continuum::twin_pivot {

/// A load case made ready for evaluation: the condition is resolved into numbers.
struct Task {
  Task(const Robot& robot, const Load& load, Method method);

  /// The loads on the way from another task of this robot (share 0) to this one (1), with this
  /// one's friction and reference.
  Task Between(const Task& from, double share) const;
  /// The same without any load.
  Task Unloaded() const;

  const Robot& robot;
  Method method;
  int joints, cables;
  std::vector<Link> links;
  Eigen::VectorXd stiffness;  ///< of every joint [N m/rad]
  Friction friction;          ///< all zero when there is none
  Eigen::VectorXd m_D,
      m_NiTi;                 ///< weights that count, of every disc with its payload and joint [kg]
  Eigen::VectorXd rho, m_CL;  ///< of every cable [kg/m] and of its lock [kg]
  double payload;             ///< at the tip
  Eigen::Vector3d gravity, force, moment;
  std::vector<DiscLoad> loads;  ///< on other discs, none of which is all zero
  std::vector<double> tension;  ///< F_SC [N]
  std::vector<int> anchor;      ///< last joint of every cable, counted from 1
  /// Distance of every cable from the two axes of a disc with even number: y for odd joints, z for
  /// even ones.
  std::vector<double> hole_y, hole_z;
  Eigen::MatrixXd reference;  ///< l_ref, joints x cables [m]
  Eigen::MatrixXd slide;      ///< s of the contacts there

  bool HasFriction() const { return friction.a != 0 || friction.b != 0 || friction.c != 0; }
  /// Distance of cable j from the bending axis of joint m (0 = first), toward its +y.
  double Y(int m, int j) const { return m % 2 == 0 ? hole_y[j] : hole_z[j]; }
  /// Where the cable stands along the bending axis itself.
  double Z(int m, int j) const { return m % 2 == 0 ? hole_z[j] : -hole_y[j]; }
};

/// Cable forces (5), (11)-(16): F_mj [N] in every joint, row m of `cables` entries, 0 beyond the
/// anchor.
///
///   F_1 = F_SC / (1 - s_0 w_1),  F_m+1 = F_m (1 + s_m w_m) / (1 - s_m w_m+1),
///   s_m = SlideFrom(s_ref, sum over joints m+1..anchor of (l - l_ref) / eps)
///
/// or s_m as in `frozen`, when given; `slide`, when given, gets s_m. @returns false when a contact
/// would lock, s w >= 1.
template <class T>
bool CableForces(const Task& task, const std::vector<Joint<T>>& joint, double friction, double eps,
                 std::vector<T>& force, const Eigen::MatrixXd* frozen = nullptr,
                 Eigen::MatrixXd* slide = nullptr) {
  force.assign(task.joints * task.cables, T(0));
  std::vector<T> w;
  for (const Joint<T>& at : joint) w.push_back(friction * FrictionShare(task.friction, at.beta));
  const bool slides = friction != 0 && task.HasFriction();
  std::vector<T> change(task.joints + 1, T(0));
  for (int j = 0; j < task.cables; ++j) {
    const int last = task.anchor[j];
    if (slides) {
      change[last] = T(0);
      for (int m = last - 1; m >= 0; --m) {
        change[m] = change[m + 1] + joint[m].Length(task.Y(m, j)) - task.reference(m, j);
      }
    }
    T carried = T(task.tension[j]);
    for (int m = 0; m < last; ++m) {
      if (slides) {
        const T s =
            frozen ? T((*frozen)(m, j)) : statics::SlideFrom(task.slide(m, j), T(change[m] / eps));
        if (slide) (*slide)(m, j) = Value(s);
        const T yield = 1.0 - s * w[m];
        if (!(Value(yield) > 0)) return false;
        if (m > 0) carried *= 1.0 + s * w[m - 1];
        if (!(Value(carried) >= 0)) return false;
        carried /= yield;
      }
      force[m * task.cables + j] = carried;
    }
  }
  return true;
}

/// Bodies beyond a point: their mass and first moment, and the place of the tip.
template <class T>
struct Beyond {
  T mass = T(0);
  Vector<T> first = {T(0), T(0), T(0)};  ///< sum of mass times place [kg m]
  Vector<T> tip = {T(0), T(0), T(0)};    ///< O_n [m]

  void Add(const T& m, const T& x, const T& y, const T& z) {
    mass += m;
    first[0] += m * x;
    first[1] += m * y;
    first[2] += m * z;
  }
};

/// f_m(beta), m = 1..n [N m]: the balance of moments in every joint, (17)-(41).
///
/// kVirtualWork, about the centroid c_m of the bent rod m, which is the instantaneous centre of
/// everything beyond it:
///
///   f_m = sum_j F_mj (-dl_mj/dbeta_m) + z_m . [sum_beyond (p_k - c_m) x W_k
///         + (p_n - c_m) x F_EX + M_EX] + W_rod . dc_m/dbeta + sum_j W_mj . d(mid)/dbeta
///         - rods E I_z beta_m / L
///
/// kPrinted, about O_m-1 with the joint's own rod and cables among the bodies:
///
///   f_m = sum_j F_mj (y_mj cos(beta/2) - (h/2) sin(beta/2)) + z_m . [sum (p_k - O_m-1) x W_k +
///   ...]
///         - rods E I_z beta_m / L
///
/// F_EX, M_EX: on every disc that has them, p_n the place of that disc. Three passes over the
/// joints, O(n): cable forces, the base frame's vectors outward, masses inward. `load` scales
/// everything that acts, `friction` the coefficients of friction; for continuation.
struct Balance {
  const Task& task;
  double load = 1;
  double friction = 1;
  double eps = 1e-6;
  const Eigen::MatrixXd* frozen = nullptr;  ///< s of the contacts, whatever slides

  // Flattened: products of dual numbers are so short that calls would cost more than the work.
  template <class T>
  [[gnu::flatten]] bool operator()(const T* beta, T* f) const {
    std::vector<Joint<T>> joint;
    joint.reserve(task.joints);
    for (int m = 0; m < task.joints; ++m) {
      if (!(std::abs(Value(beta[m])) < M_PI)) return false;
      joint.emplace_back(task.links[m], beta[m]);
    }
    std::vector<T> cable;
    if (!CableForces(task, joint, friction, eps, cable, frozen)) return false;
    Moments(joint, cable, f);
    return true;
  }

 private:
  template <class T>
  struct Fixed {
    Vector<T> gravity, force, moment;
  };

  template <class T>
  std::vector<Fixed<T>> Outward(const std::vector<Joint<T>>& joint) const {
    const auto seen = [this](const Eigen::Vector3d& v) {
      return Vector<T>{T(load * v[0]), T(load * v[1]), T(load * v[2])};
    };
    std::vector<Fixed<T>> fixed = {{seen(task.gravity), seen(task.force), seen(task.moment)}};
    fixed.reserve(joint.size() + 1);
    for (int m = 0; m < task.joints; ++m) {
      const bool odd = m % 2 == 0;
      fixed.push_back({IntoNext(joint[m], odd, fixed[m].gravity),
                       IntoNext(joint[m], odd, fixed[m].force),
                       IntoNext(joint[m], odd, fixed[m].moment)});
    }
    return fixed;
  }

  template <class T>
  void Moments(const std::vector<Joint<T>>& joint, const std::vector<T>& cable, T* f) const {
    const std::vector<Fixed<T>> fixed = Outward(joint);
    const LoadsBeyond<T> loads(task.loads, load, joint);
    const bool exact = task.method == Method::kVirtualWork;
    Beyond<T> beyond;
    beyond.mass = T(task.payload);
    for (int m = task.joints - 1; m >= 0; --m) {
      const Joint<T>& at = joint[m];
      AddDisc(m, beyond);
      Carry(at, m % 2 == 0, beyond);
      if (exact) f[m] = AboutCentre(m, at, fixed[m], beyond);
      AddRodAndCables(m, at, beyond);
      if (!exact) f[m] = AboutDisc(fixed[m], beyond);
      if (!loads.empty()) {
        f[m] += exact ? loads.About(m, at.centre.x, at.centre.y) : loads.About(m, T(0), T(0));
      }
      for (int j = 0; j < task.cables; ++j) {
        if (m >= task.anchor[j]) continue;
        const double y = task.Y(m, j);
        const T arm = exact ? at.Arm(y) : y * at.half_cosine - task.links[m].before * at.half_sine;
        f[m] += load * cable[m * task.cables + j] * arm;
      }
      f[m] -= task.stiffness[m] * at.beta;
    }
  }

  /// Disc m+1 and the locks on its distal face.
  template <class T>
  void AddDisc(int m, Beyond<T>& beyond) const {
    beyond.mass += task.m_D[m];
    for (int j = 0; j < task.cables; ++j) {
      if (task.anchor[j] != m + 1) continue;
      beyond.Add(T(task.m_CL[j]), T(task.links[m].after), T(task.hole_y[j]), T(task.hole_z[j]));
    }
  }

  template <class T>
  static void Carry(const Joint<T>& at, bool odd, Beyond<T>& beyond) {
    beyond.first = IntoPrevious(at, odd, beyond.first);
    beyond.tip = IntoPrevious(at, odd, beyond.tip);
    beyond.first[0] += beyond.mass * at.origin.x;
    beyond.first[1] += beyond.mass * at.origin.y;
    beyond.tip[0] += at.origin.x;
    beyond.tip[1] += at.origin.y;
  }

  template <class T>
  T AboutCentre(int m, const Joint<T>& at, const Fixed<T>& fixed, const Beyond<T>& beyond) const {
    const Planar<T>& c = at.centre;
    const Vector<T>& g = fixed.gravity;
    T moment = fixed.moment[2] + CrossZ(beyond.tip[0] - c.x, beyond.tip[1] - c.y, fixed.force) +
               CrossZ(beyond.first[0] - beyond.mass * c.x, beyond.first[1] - beyond.mass * c.y, g);
    moment += task.m_NiTi[m] * (g[0] * at.centre_slope.x + g[1] * at.centre_slope.y);
    for (int j = 0; j < task.cables; ++j) {
      if (m >= task.anchor[j]) continue;
      const double y = task.Y(m, j);
      const Planar<T> hole = at.Hole(y);
      moment += 0.5 * task.rho[j] * at.Length(y) * CrossZ(hole.x - c.x, hole.y - c.y, g);
    }
    return moment;
  }

  template <class T>
  void AddRodAndCables(int m, const Joint<T>& at, Beyond<T>& beyond) const {
    beyond.Add(T(task.m_NiTi[m]), at.centre.x, at.centre.y, T(0));
    for (int j = 0; j < task.cables; ++j) {
      if (m >= task.anchor[j]) continue;
      const double y = task.Y(m, j);
      const Planar<T> hole = at.Hole(y);
      beyond.Add(task.rho[j] * at.Length(y), 0.5 * (task.links[m].before + hole.x),
                 0.5 * (y + hole.y), T(task.Z(m, j)));
    }
  }

  template <class T>
  T AboutDisc(const Fixed<T>& fixed, const Beyond<T>& beyond) const {
    return fixed.moment[2] + CrossZ(beyond.tip[0], beyond.tip[1], fixed.force) +
           CrossZ(beyond.first[0], beyond.first[1], fixed.gravity);
  }
};

}  // namespace continuum::twin_pivot
