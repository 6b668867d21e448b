#pragma once

#include <functional>
#include <optional>
#include <string>

namespace continuum::hidden {

/// What a process of its own answers, so that none that crashes or hangs costs the others.
struct ChildAnswer {
  std::optional<std::string> text = {};  ///< none: it crashed, or was ended at the limit
  bool late = false;                     ///< ended at a limit
};

/// Runs work in a child process for at most so many seconds of processor time, which other work on
/// the machine does not shorten, and 20 times that by the clock. Call it before threads are
/// started.
ChildAnswer InChild(const std::function<std::string()>& work, double limit);

}  // namespace continuum::hidden
