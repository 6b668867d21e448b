#pragma once

#include "models/statics/reach.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// Linear systems of the search for one target: then it is given up. Those of path.csv take 88.
constexpr long kMostOfReach = 100000;

/// A case that another goes on from.
struct Before {
  const Load& load;
  const Solution& solution;
};

/// The least tensions [N] that bring discs of a case to a target (statics::Reach), from those of
/// `load`. With `before`, its contacts go on from there: friction of all that was before counts.
statics::Reached Reach(const Robot& robot, const Load& load, Method method,
                       const statics::Target& target, const Before* before);

/// The lengths [m] of cables that bring discs to a target (statics::Wind), for a load that is
/// driven by length: from those of the least tensions, which are looked for from the tensions of
/// the given lengths.
statics::Reached ReachByLengths(const Robot& robot, const Load& load, Method method,
                                const statics::Target& target, const Before* before);

/// As Reach, by statics::Nearest: as near as it comes by low tensions.
statics::Reached Approach(const Robot& robot, const Load& load, Method method,
                          const statics::Target& target, const Before* before);

/// Solves a case from straight or from the one before, whose contacts `load` then gets. The
/// solution has the tensions as `pull`, however they are driven.
Solution SolveGoingOn(const Robot& robot, Load& load, Method method, const Before* before);

}  // namespace continuum::twin_pivot
