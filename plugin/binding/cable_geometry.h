#pragma once

#include <span>
#include <vector>

#include "binding/cable.h"

namespace continuum {

/// Where several cables run and how they move at d. Segments, and the
/// entries of their Jacobians dL/dq that are not zero, are counted over all cables; contact s is
/// the site in front of segment s.
struct CableGeometry {
  CableGeometry(const mjModel& m, std::span<const Cable> cables);

  int cables() const { return static_cast<int>(first.size()) - 1; }
  int segments() const { return first.back(); }
  int entries() const { return begin.back(); }

  void Update(const mjData& d);
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

  std::vector<int> first;  ///< [cables + 1] segment of each cable
  std::vector<int> begin;  ///< [segments + 1] entry of each segment
  std::vector<int> dof;    ///< [entries]

  std::vector<double> theta;  ///< [segments] wrap angle at each contact, 0 at a cable's first [rad]
  std::vector<double> slip;  ///< [segments] −Σ_{k ≥ s} dL_k/dt of its cable, > 0 when pulled [m/s]
  std::vector<double> arm;  ///< [entries] dL/dq [m/rad or 1]

 private:
  void Directions(const mjData& d);
  void Angles();
  double HalfCosine(int s) const;
  void Arms(const mjData& d);

  std::vector<int> near_, far_;    // [segments] sites
  std::vector<int> root_;          // [entries] body whose tree the dof belongs to
  std::vector<double> sign_;       // [entries]
  std::vector<double> x_, y_, z_;  // [segments] direction
  std::vector<double> half_;       // [segments] sin²(θ/2)
};

}  // namespace continuum
