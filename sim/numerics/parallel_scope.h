#pragma once

namespace continuum {

/// Whether the calling thread is within the work of a ParallelFor (parallel.h), so that more of it
/// runs on this thread alone.
bool InParallelFor();

}  // namespace continuum
