#pragma once

#include <vector>

#include "models/statics/details.h"
#include "models/statics/shape_table.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// Of a solution of the forward or the inverse model with status kOk. The strain is that of the
/// wall's outermost fibres along the axis. The energy is the work of every section's forces along
/// the straight way of its strains, pressures included, less the work of weights and tip force. It
/// is a potential of `fixed+fixed`; the other sections do not have one quite. NaN of the inverse
/// model.
statics::Details Describe(const ModuleSeries& series, const Method& method, Direction direction,
                          const Case& row, const Solution& solution);

/// Places along the axis of a solution of the forward model; the base is disk 0, the upper end of
/// the soft part of module i is disk i. `s` counts mounts.
std::vector<statics::Place> Places(const ModuleSeries& series, const Method& method,
                                   const Case& row, const Solution& solution);

/// The upper ends of the soft parts of all modules [m].
Eigen::Matrix3Xd EndsOf(const ModuleSeries& series, const Method& method, const Case& row,
                        const Solution& solution);

}  // namespace continuum::stiff_flop
