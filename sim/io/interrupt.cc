#include "sim/io/interrupt.h"

#include <atomic>

#include "error.h"

namespace continuum {
namespace {
std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // set from a signal handler
}  // namespace

void RequestStop() { stop_requested = true; }
bool StopRequested() { return stop_requested; }

void StopIfRequested() {
  if (StopRequested()) throw Error::Job("interrupted");
}

}  // namespace continuum
