#include "sim/io/interrupt.h"

#include <atomic>

#include "error.h"

namespace continuum {
namespace {
std::atomic<bool> stop_requested = false, end_requested = false, graceful = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // set from a signal handler
}  // namespace

void RequestStop() {
  if (!graceful || end_requested) stop_requested = true;
  end_requested = true;
}
bool StopRequested() { return stop_requested; }

GracefulEnd::GracefulEnd() { graceful = true; }
GracefulEnd::~GracefulEnd() { graceful = false; }

bool EndRequested() { return end_requested; }

void StopIfRequested() {
  if (StopRequested()) throw Error::Job("interrupted");
}

}  // namespace continuum
