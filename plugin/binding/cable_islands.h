#pragma once

#include <span>
#include <vector>

#include "binding/articulated_inertia.h"
#include "binding/cable_geometry.h"
#include "binding/solved_row.h"
#include "binding/step_inertia.h"

namespace continuum {

/// Which cables are solved together: those that have a kinematic tree in common, or trees that rows
/// of the step link, as contacts do. Each such island has an inertia of its own.
class CableIslands {
 public:
  CableIslands(const mjModel& m, const CableGeometry& geometry);

  /// Takes up the rows of a step. A law with cables in one order of islands has those of an island
  /// without rows in a contiguous run.
  void Link(const mjModel& m, const CableGeometry& geometry, std::span<const SolvedRow> rows);

  int size() const { return static_cast<int>(inertias_.size()); }
  int of_cable(int cable) const { return of_cable_[cable]; }
  StepInertia& inertia(int island) { return inertias_[island]; }
  const StepInertia& inertia(int island) const { return inertias_[island]; }
  /// The same joints, without the ends of cables.
  ArticulatedInertia& articulated(int island) { return articulated_[island]; }
  /// Rows that act on an island; rows that act on none are left out.
  std::span<const int> rows(int island) const { return rows_[island]; }
  /// Place of an entry's degree of freedom in the inertia of its island.
  int place(int entry) const { return place_[entry]; }
  /// Place of the far end of a cable that is pulled at both ends; −1: something holds it.
  int end(int cable) const { return end_[cable]; }

 private:
  void Build(const mjModel& m, const CableGeometry& geometry);
  void AddPlaces(const CableGeometry& geometry, int cable);

  std::vector<std::vector<int>> moved_;  // [cables + rows] degrees of freedom
  std::vector<int> island_of_tree_;      // [ntree] −1: no cable
  std::vector<int> of_cable_;
  std::vector<std::vector<int>> rows_;  // [islands]
  std::vector<StepInertia> inertias_;
  std::vector<ArticulatedInertia> articulated_;
  std::vector<int> place_;
  std::vector<int> end_;  // [cables]
};

}  // namespace continuum
