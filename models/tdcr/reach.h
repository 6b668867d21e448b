#pragma once

#include "models/statics/reach.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// Linear systems of the search for one target: then it is given up. Those of path.csv take
/// 1399 at most (eas).
constexpr long kMostOfReach = 100000;

/// A case that another goes on from.
struct Before {
  const Loads& loads;
  const Solution& solution;
};

/// The least tensions [N] that bring disks of a case to a target (statics::Reach), from those of
/// `loads`. With `before`, its contacts go on from there: friction of all that was before counts.
statics::Reached Reach(const Robot& robot, const Loads& loads, Method method,
                       const statics::Target& target, const Before* before);

/// The lengths [m] of tendons that bring disks to a target (statics::Wind), for loads that are
/// driven by length: from those of the least tensions, which are looked for from the tensions of
/// the given lengths.
statics::Reached ReachByLengths(const Robot& robot, const Loads& loads, Method method,
                                const statics::Target& target, const Before* before);

}  // namespace continuum::tdcr
