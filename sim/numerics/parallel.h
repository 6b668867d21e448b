#pragma once

#include <cstddef>
#include <functional>

#include "sim/io/interrupt.h"

namespace continuum {

/// Threads that parallel work uses: one per core.
std::size_t ThreadCount();

/// Processor time that all threads of this process have used so far [s]. Work that is limited by it
/// ends at the same place however busy the machine is.
double ProcessorSeconds();

/// Calls work(thread, i) for all i < n on ThreadCount() threads; an exception of any call is
/// rethrown when all have ended. Within such work another ParallelFor runs on its thread alone,
/// with the number of that; but a single call, as thread 0, leaves all threads to those within it.
void ParallelFor(std::size_t n, const std::function<void(std::size_t thread, std::size_t i)>& work);

}  // namespace continuum
