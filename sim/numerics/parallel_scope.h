#pragma once

#include <cstddef>

namespace continuum {

/// Whether the calling thread is within the work of a ParallelFor (parallel.h), so that more of it
/// runs on this thread alone.
bool InParallelFor();

/// Which thread of it that is; 0 outside.
std::size_t ThisThread();

}  // namespace continuum
