#pragma once

#include <vector>

#include "models/statics/held.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// What a solved case holds beside its tip.
struct Held {
  statics::Hold hold;  ///< strain: of the wall's outermost fibres, along the axis
  /// Work of every section's forces along the straight way of its strains, pressures included, less
  /// the work of weights and tip force [J]; 0 of the straight module. A potential of
  /// `fixed+fixed`; the other sections do not have one quite. NaN of the inverse model.
  double energy;
};

/// Of a solution of the forward or the inverse model with status kOk.
Held Describe(const Module& module, const Method& method, Direction direction, const Case& row,
              const Solution& solution);

/// Places along the axis of a solution of the forward model; the two ends are disks 0 and 1.
std::vector<statics::ShapeTable::Place> Places(const Module& module, const Method& method,
                                               const Case& row, const Solution& solution);

}  // namespace continuum::stiff_flop
