#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "sim/model/model_spec.h"

namespace continuum {

/// What a principal inertia that is free alone of its body's three can be,
///
///   |I_j − I_k| ≤ I_i ≤ I_j + I_k,
///
/// where the model holds to it (<compiler balanceinertia> does not). Beyond that no machine
/// compiles.
class InertiaLimits {
 public:
  /// Of free[which]; none where that sets no such inertia, or another one is free of the same body.
  static std::optional<InertiaLimits> Of(const ModelSpec& system, std::span<const Change> free,
                                         std::size_t which);
  /// "inertia[0]".
  static std::string Name(std::size_t axis);

  std::size_t axis() const { return axis_; }
  double least() const { return least_; }
  double most() const { return most_; }
  /// Whether the model refuses what lies a thousandth beyond.
  bool HoldBelow() const { return !Compiles((1 - kBeyond) * least_); }
  bool HoldAbove() const { return !Compiles((1 + kBeyond) * most_); }

 private:
  static constexpr double kBeyond = 1e-3;

  InertiaLimits(const ModelSpec& system, const Change& change, std::size_t axis);
  bool Compiles(double value) const;

  const ModelSpec* system_;
  Change change_;
  std::size_t axis_;
  double least_, most_;
};

}  // namespace continuum
