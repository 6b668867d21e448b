#pragma once

#include <functional>
#include <optional>
#include <string>

namespace continuum::hidden {

/// What a process of its own answers, so that none that crashes or hangs costs the others.
struct ChildAnswer {
  std::optional<std::string> text = {};  ///< none: it crashed, or was ended at the limit
  bool late = false;                     ///< ended at the limit
};

/// Runs work in a child process for at most so many seconds. Call it before threads are started.
ChildAnswer InChild(const std::function<std::string()>& work, double limit);

}  // namespace continuum::hidden
