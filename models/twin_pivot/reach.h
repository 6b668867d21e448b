#pragma once

#include "models/statics/reach.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// A case that another goes on from.
struct Before {
  const Load& load;
  const Solution& solution;
};

/// The least tensions [N] that bring discs of a case to a target (statics::Reach), from those of
/// `load`. With `before`, its contacts go on from there: friction of all that was before counts.
statics::Reached Reach(const Robot& robot, const Load& load, Method method,
                       const statics::Target& target, const Before* before);

}  // namespace continuum::twin_pivot
