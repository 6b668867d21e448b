#pragma once

#include <span>
#include <vector>

#include "binding/cable.h"

namespace continuum {

/// Where several cables run and how they move at d. Segments, and the
/// entries of their Jacobians dL/dq that are not zero, are counted over all cables; contact s is
/// the site or geom in front of segment s.
///
/// A geom that is wrapped counts as two points of its body, MuJoCo's tangent points. They are
/// stationary for the length of the shortest path, so dL/dq is that of the straight parts alone,
/// with the points fixed to the geom. The wrap angle is the integral of the curvature along the
/// geom,
///
///   θ = φ cos α                                                              (1)
///
/// φ [rad] angle of the arc about the axis of a cylinder (the centre of a sphere) · α pitch of the
/// helix on a cylinder (0 on a sphere). Where the path only bends at a geom (inside wraps) θ is the
/// angle between the straight parts. A geom that the path misses is no contact: θ = 0, and the
/// segments meet at the point of the straight line that is nearest to the geom's centre or axis.
struct CableGeometry {
  CableGeometry(const mjModel& m, std::span<const Cable> cables);

  int cables() const { return static_cast<int>(first.size()) - 1; }
  int segments() const { return first.back(); }
  int entries() const { return begin.back(); }

  void Update(const mjModel& m, const mjData& d);
  /// dL_s/dt of a segment at the velocities v [nv].
  double Rate(int s, const double* v) const {
    double rate = 0;
    for (int l = begin[s]; l < begin[s + 1]; ++l) rate += arm[l] * v[dof[l]];
    return rate;
  }
  /// force[nv] += f dL_s/dq.
  void Add(int s, double f, double* force) const {
    for (int l = begin[s]; l < begin[s + 1]; ++l) force[dof[l]] += arm[l] * f;
  }
  /// World coordinates of the ends of a segment, and the unit vector from one to the other.
  const double* Near(const mjData& d, int s) const { return At(d, near_[s]); }
  const double* Far(const mjData& d, int s) const { return At(d, far_[s]); }
  void Along(int s, double* direction) const {
    direction[0] = x_[s], direction[1] = y_[s], direction[2] = z_[s];
  }

  std::vector<int> first;  ///< [cables + 1] segment of each cable
  std::vector<bool> both;  ///< [cables] pulled at both ends
  std::vector<int> begin;  ///< [segments + 1] entry of each segment
  std::vector<int> dof;    ///< [entries]

  std::vector<double> theta;  ///< [segments] wrap angle at each contact, 0 at a cable's first [rad]
  std::vector<double> slip;  ///< [segments] −Σ_{k ≥ s} dL_k/dt of its cable, > 0 when pulled [m/s]
  std::vector<double> arm;  ///< [entries] dL/dq [m/rad or 1]

 private:
  // A geom between two sites, which may touch the path.
  struct Wrap {
    int tendon, item;  // of the tendon's path
    int segment;       // behind it
    bool reversed;
    bool touches;
  };
  const double* At(const mjData& d, int point) const {
    return point >= 0 ? d.site_xpos + 3 * point : tangent_.data() + 3 * ~point;
  }
  void AddWrap(const Cable& cable, int k);
  void FindTangents(const mjModel& m, const mjData& d);
  void Miss(const mjModel& m, const mjData& d, const Wrap& wrap, double* tangents) const;
  double WrapAngle(const mjModel& m, const mjData& d, const Wrap& wrap) const;
  void Directions(const mjData& d);
  void FillDirections(const mjData& d, int cable);
  void Angles();
  double HalfCosine(int s) const;
  void Arms(const mjData& d);

  std::vector<int> near_, far_;    // [segments] sites, or ~ the number of a tangent point
  std::vector<int> root_;          // [entries] body whose tree the dof belongs to
  std::vector<double> sign_;       // [entries]
  std::vector<double> x_, y_, z_;  // [segments] direction
  std::vector<double> half_;       // [segments] sin²(θ/2)
  std::vector<Wrap> wraps_;
  std::vector<double> tangent_;  // [2 wraps · 3] points
};

}  // namespace continuum
