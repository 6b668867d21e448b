#pragma once

#include "identification/problem/last_runs.h"
#include "sim/model/change.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// All members, for BytesOut and BytesIn (sim/numerics/bytes.h).
template <class A>
void Fields(A& a, Trace& t) {
  auto& [channel, diverged, diverged_at, raw, axes, why] = t;
  a(channel, diverged, diverged_at, raw, axes, why);
}

template <class A>
void Fields(A& a, Change& c) {
  auto& [target, attribute, value, operation] = c;
  a(target, attribute, value, operation);
}

template <class A>
void Fields(A& a, LastRun& r) {
  auto& [changes, starts, theta, skew, trace] = r;
  a(changes, starts, theta, skew, trace);
}

}  // namespace continuum
