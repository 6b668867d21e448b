#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace continuum {

/// A program to run to its end.
struct ChildCommand {
  std::vector<std::string> words;  ///< the program's file, and its arguments
  std::filesystem::path folder;    ///< in which it runs
  std::filesystem::path output;    ///< the file that takes its standard output
};

/// What became of it.
struct ChildEnd {
  int exit_code = -1;            ///< -1: a signal ended it
  int signal = 0;                ///< that ended it, or 0
  std::string messages;          ///< what it wrote to standard error
  double seconds = 0;            ///< by the clock
  double processor_seconds = 0;  ///< of all its threads
  double peak_megabytes = 0;     ///< of memory [1e6 bytes]
  bool stopped = false;          ///< by us, as the user asked to stop (StopRequested)

  /// "ended by signal 9"; empty when it ended by itself.
  std::string InWords() const;
};

/// Runs a program; `line` hears each line of its standard error. It has a process group of its own
/// and dies with this process, also by kill -9. When the user asks to stop, it is killed. Throws
/// Error when it cannot be started.
ChildEnd RunChild(const ChildCommand& command,
                  const std::function<void(const std::string& line)>& line);

}  // namespace continuum
