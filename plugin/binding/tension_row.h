#pragma once

#include <span>
#include <vector>

#include "binding/cable.h"

namespace continuum {

/// A row of the constraint solver that pulls tendons: a length limit or an equality.
///
///   λ = D (a_ref − J a),   J = −Σ_t c_t dL_t/dq                              (1)
///
/// λ [N] its force, c_t [1] the tension that it gives to tendon t for each unit of λ. Source:
/// MuJoCo's constraint model.
struct TensionRow {
  struct Share {
    int tendon;
    double tension;  ///< c_t
  };
  int row;
  bool limit;  ///< λ ≥ 0; an equality pulls or pushes
  std::vector<Share> shares;

  /// c_t of a tendon; 0: the row does not pull it.
  double On(int tendon) const;
};

/// Finds such rows of the tendons of some cables.
class TensionRows {
 public:
  TensionRows(const mjModel& m, std::span<const Cable> cables);

  /// Whether the model has any such limit or equality.
  bool any() const { return any_; }
  /// Those that exist at d.
  std::vector<TensionRow> At(const mjModel& m, const mjData& d) const;

 private:
  bool Pulls(int tendon) const { return tendon >= 0 && pulled_[tendon]; }

  std::vector<bool> pulled_;  // [ntendon] has a cable of ours
  bool any_ = false;
};

}  // namespace continuum
