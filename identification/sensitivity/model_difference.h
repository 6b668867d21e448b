#pragma once

#include <array>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "sim/simulation/simulate.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Where a model differs from another one, of all that its motion depends on.
struct ModelDifference {
  ModelDifference(const mjModel& m, const mjModel& other);
  /// Adds the forces of actuators that a log may switch off: they show no difference now, but may
  /// later.
  void AddGated(const Wiring& wiring);

  std::vector<int> joints;       ///< springs and dampers
  std::vector<int> armatures;    ///< dofs
  std::vector<int> frictions;    ///< dofs, with native dry friction
  std::vector<int> tendons;      ///< springs and dampers
  std::vector<int> actuators;    ///< forces
  std::vector<int> activations;  ///< actuators whose lag differs
  struct Body {
    int id;
    /// Of `other` less of m: mass [kg], mass times centre [kg m], inertia about the body's origin
    /// xx yy zz xy xz yz [kg m²], in the body's frame.
    std::array<double, 10> inertia;
  };
  std::vector<Body> bodies;
  bool gravity = false;
  std::string field;  ///< of mjModel, one that differs and is none of these; empty: none
  bool alike;         ///< whether all sizes are the same
};

}  // namespace continuum
