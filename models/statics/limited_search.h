#pragma once

#include "models/statics/reach.h"
#include "sim/numerics/work_limit.h"

namespace continuum::statics {

/// A search for drives, given up after so many linear systems.
template <class Search>
Reached LimitedSearch(long most, Search&& search) {
  Reached reached;
  const auto outcome = numerics::Limited(most, [&] {
    reached = search();
    return reached.outcome;
  });
  reached.outcome = outcome;
  return reached;
}

}  // namespace continuum::statics
