#include "sim/simulation/trace.h"

#include <fmt/format.h>

#include "sim/io/interrupt.h"

namespace continuum {

std::string Trace::Failure() const {
  return why.empty() ? fmt::format("the simulation diverges at {:g} s", diverged_at) : why;
}

Hooks Hooks::Stoppable() {
  Hooks hooks;
  hooks.step = [](const mjModel&, mjData&) { StopIfRequested(); };
  return hooks;
}

}  // namespace continuum
