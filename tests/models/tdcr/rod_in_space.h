#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// The rod without friction by other means than RodBalance: forces and moments in space (Rucker &
/// Webster 2011). With the tendon's place P = p + R a, its unit tangent t and tension T,
///
///   p' = R e_3,  R' = R [u]x,  K (u - u_0) = R^T m                                          (1)
///   n' = -f - weight,  m' = -p' x n - l,  f = sum T t',  l = sum R a x T t'                 (2)
///
/// and at disks m and n fall by their loads, by T t where a tendon ends and by T (t_before - t)
/// where it turns. t' depends on u', which (2) gives by a linear system. Walks from the base by
/// Runge-Kutta's fourth order: an equilibrium has a free tip, m = n = 0.
class RodInSpace {
 public:
  RodInSpace(const Robot& robot, Loads loads, int steps)
      : robot_(robot), loads_(std::move(loads)), steps_(steps), disks_(3, robot.disks) {
    for (const Section& section : robot.Sections()) {
      for (std::size_t i = 0; i < section.disks.size(); ++i) sections_.push_back(section);
    }
    for (int k = 0; k < robot.tendons; ++k) routes_.push_back(robot.RouteOf(k));
  }

  /// Walks from a base of curvature u (kappa_x, kappa_y, tau as a rotation vector) [1/m].
  void Walk(const Eigen::Vector3d& u) {
    const Section& first = sections_.front();
    const Vector3 rest(-first.natural.y(), first.natural.x(), first.natural.z());
    State y{Vector3::Zero(), Vector3::Zero(), loads_.tip_force, Matrix3::Identity()};
    y.m = Vector3(first.EI, first.EI, first.GJ).cwiseProduct(u - rest);
    for (int arc = 0; arc < robot_.disks; ++arc)
      y.n += Weight(arc) + AtDisk(loads_.disk_force, arc);
    for (std::size_t k = 0; k < routes_.size(); ++k) y.n -= Pull(k) * Tangent(k, 0, 0, y);
    for (int arc = 0; arc < robot_.disks; ++arc) {
      y = Walk(arc, y);
      disks_.col(arc) = y.p;
      Pass(arc, y);
    }
    moment_ = y.m;
    force_ = y.n;
  }
  const Eigen::Matrix3Xd& disks() const { return disks_; }   ///< O_1..O_n [m]
  const Eigen::Vector3d& moment() const { return moment_; }  ///< beyond the tip [N m]
  const Eigen::Vector3d& force() const { return force_; }    ///< beyond the tip [N]

 private:
  using Vector3 = Eigen::Vector3d;
  using Matrix3 = Eigen::Matrix3d;
  struct State {
    Vector3 p, m, n;
    Matrix3 R;
    State Plus(double h, const State& d) const {
      return {p + h * d.p, m + h * d.m, n + h * d.n, R + h * d.R};
    }
  };
  struct Hole {
    Vector3 a, slope, turn;
  };

  static Matrix3 Skew(const Vector3& v) {
    Matrix3 s;
    s << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return s;
  }
  double Pull(std::size_t k) const { return loads_.tension[k]; }
  static Vector3 AtDisk(const Eigen::Matrix3Xd& loads, int arc) {
    return loads.cols() > 0 ? Vector3(loads.col(arc)) : Vector3::Zero();
  }
  // Of an arc and the disk at its end.
  Vector3 Weight(int arc) const {
    const double length = robot_.Place(arc + 1) - robot_.Place(arc);
    return (Of(arc).disk_mass + Of(arc).mass_per_length * length) * loads_.gravity;
  }
  const Section& Of(int arc) const { return sections_[static_cast<std::size_t>(arc)]; }
  Vector3 Curvature(int arc, const State& y) const {
    const Section& section = Of(arc);
    const Vector3 b = y.R.transpose() * y.m, k = section.natural;
    return Vector3(b.x() / section.EI - k.y(), b.y() / section.EI + k.x(),
                   b.z() / section.GJ + k.z());
  }
  Hole At(std::size_t k, int arc, double s) const {
    const auto i = static_cast<std::size_t>(arc);
    const Route& route = routes_[k];
    const double from = robot_.Place(arc), length = robot_.Place(arc + 1) - from;
    const double dr = (route.radius[i + 1] - route.radius[i]) / length;
    const double dq = (route.angle[i + 1] - route.angle[i]) / length;
    const double r = route.radius[i] + dr * (s - from), q = route.angle[i] + dq * (s - from);
    const Vector3 e(std::cos(q), std::sin(q), 0), n(-std::sin(q), std::cos(q), 0);
    return {r * e, dr * e + r * dq * n, 2 * dr * dq * n - r * dq * dq * e};
  }

  State Slope(int arc, double s, const State& y) const {
    const Section& section = Of(arc);
    const Vector3 u = Curvature(arc, y), e3 = Vector3::UnitZ();
    Matrix3 by_f = Matrix3::Zero(), by_l = Matrix3::Zero();  // f = f_0 + by_f u', in the section
    Vector3 f = Vector3::Zero(), l = Vector3::Zero();
    for (std::size_t k = 0; k < routes_.size(); ++k) {
      if (arc >= routes_[k].end()) continue;
      const Hole hole = At(k, arc, s);
      const Vector3 along = u.cross(hole.a) + hole.slope + e3;
      const Vector3 known = u.cross(along) + u.cross(hole.slope) + hole.turn;
      const Matrix3 across = -Pull(k) / std::pow(along.norm(), 3) * Skew(along) * Skew(along);
      f += across * known;
      l += hole.a.cross(across * known);
      by_f -= across * Skew(hole.a);
      by_l -= Skew(hole.a) * across * Skew(hole.a);
    }
    const Matrix3 K = Vector3(section.EI, section.EI, section.GJ).asDiagonal();
    const Vector3 right = -e3.cross(y.R.transpose() * y.n) - l - u.cross(y.R.transpose() * y.m);
    const Vector3 du = Matrix3(K + by_l).lu().solve(right);
    State d;
    d.p = y.R * e3;
    d.R = y.R * Skew(u);
    d.m = -d.p.cross(y.n) - y.R * (l + by_l * du);
    d.n = -y.R * (f + by_f * du) - section.mass_per_length * loads_.gravity;
    return d;
  }

  Vector3 Tangent(std::size_t k, int arc, double s, const State& y) const {
    const Hole hole = At(k, arc, s);
    const Vector3 u = Curvature(arc, y);
    return y.R * (u.cross(hole.a) + hole.slope + Vector3::UnitZ()).normalized();
  }

  State Walk(int arc, State y) const {
    const double h = (robot_.Place(arc + 1) - robot_.Place(arc)) / steps_;
    for (int i = 0; i < steps_; ++i) {
      const double s = robot_.Place(arc) + i * h;
      const State a = Slope(arc, s, y), b = Slope(arc, s + h / 2, y.Plus(h / 2, a));
      const State c = Slope(arc, s + h / 2, y.Plus(h / 2, b));
      const State d = Slope(arc, s + h, y.Plus(h, c));
      y = y.Plus(h / 6, a).Plus(h / 3, b).Plus(h / 3, c).Plus(h / 6, d);
      y.R = Eigen::Quaterniond(y.R).normalized().toRotationMatrix();
    }
    return y;
  }

  // Past the disk where an arc ends. The tangents beyond it depend on what they do to m.
  void Pass(int arc, State& y) const {
    const double s = robot_.Place(arc + 1);
    const bool last = arc + 1 == robot_.disks;
    Vector3 force = Of(arc).disk_mass * loads_.gravity + AtDisk(loads_.disk_force, arc);
    if (last) force += loads_.tip_force;
    const State before = y;
    y.n -= force;
    y.m -= AtDisk(loads_.disk_moment, arc);
    const State loaded = y;
    for (int round = 0; round < (last ? 1 : 60); ++round) {
      State next = loaded;
      for (std::size_t k = 0; k < routes_.size(); ++k) {
        if (arc >= routes_[k].end()) continue;
        Vector3 pull = -Pull(k) * Tangent(k, arc, s, before);
        if (arc + 1 < routes_[k].end()) pull += Pull(k) * Tangent(k, arc + 1, s, y);
        next.n -= pull;
        next.m -= (y.R * At(k, arc, s).a).cross(pull);
      }
      const bool same = (next.m - y.m).norm() < 1e-15;
      y = next;
      if (same) break;
    }
  }

  const Robot& robot_;
  Loads loads_;
  int steps_;
  std::vector<Section> sections_;  ///< of the arcs
  std::vector<Route> routes_;
  Eigen::Matrix3Xd disks_;
  Vector3 moment_ = Vector3::Zero(), force_ = Vector3::Zero();
};

}  // namespace continuum::tdcr
