#pragma once

#include <functional>
#include <string>
#include <vector>

namespace continuum::testing {

/// What became of some work in a process of its own.
struct Ended {
  int exit_code = -1;
  int signal = 0;         ///< that ended it, or 0
  bool too_long = false;  ///< it was ended after its time
  double seconds = 0;
  std::string text;                ///< what the work returned
  std::vector<std::string> trace;  ///< innermost first, where a signal ended it
};

/// Does work in a process of its own, of which nothing is left in this one whatever happens, so
/// that none that crashes or hangs costs the others. limit: seconds of processor time, of all its
/// threads together, which other work on the machine does not shorten; waits: so many times as many
/// on the clock. Call it before threads are started.
Ended InChild(const std::function<std::string()>& work, unsigned limit, unsigned waits = 10);

}  // namespace continuum::testing
