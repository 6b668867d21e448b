#pragma once

#include <cstddef>
#include <vector>

#include "sim/numerics/parallel.h"

namespace continuum::statics {

/// Calls solve(i) for every row on all cores, and for each after the row that it goes on from:
/// reference(i), an earlier one, or -1. Rows that go on from one another share a thread, in order.
template <class Reference, class Solve>
void ForRows(std::size_t rows, const Reference& reference, const Solve& solve) {
  std::vector<std::vector<std::size_t>> chains;
  std::vector<std::size_t> chain(rows);  // of every row
  for (std::size_t i = 0; i < rows; ++i) {
    const int before = reference(i);
    if (before < 0) {
      chain[i] = chains.size();
      chains.emplace_back();
    } else {
      chain[i] = chain[static_cast<std::size_t>(before)];
    }
    chains[chain[i]].push_back(i);
  }
  ParallelFor(chains.size(), [&](std::size_t, std::size_t c) {
    for (const std::size_t i : chains[c]) solve(i);
  });
}

}  // namespace continuum::statics
