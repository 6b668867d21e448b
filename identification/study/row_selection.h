#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "identification/study/study_row.h"

namespace continuum {

/// Indices of the rows that a run takes, in the order of the table.
///
/// rows: numbers from 1, ranges and names, separated by commas, "17:32" or "3,arm-replay"; empty:
/// all. shard: "K/N", of these rows every N-th from the K-th on, K = 1 ... N; empty: all. Throws
/// Error for what names no row.
std::vector<std::size_t> SelectRows(const StudyTable& study, const std::string& rows,
                                    const std::string& shard);

}  // namespace continuum
