#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "support/scratch.h"

namespace continuum::testing {

/// What a process left behind.
struct Finished {
  int exit_code = -1;
  int signal = 0;  ///< that ended it, or 0
  std::string out, err;
};

/// A signal sent as soon as a process has written a text to standard error.
struct Interruption {
  std::string after;
  int signal = SIGINT;
};

/// Runs a program in a folder to its end; after so many seconds it is ended by SIGALRM.
inline Finished RunProcess(std::vector<std::string> command, const std::filesystem::path& folder,
                           unsigned seconds = 60, const Interruption& interruption = {}) {
  const Scratch scratch;
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = scratch / "out", err = scratch / "err";
  const pid_t child = fork();
  if (child == 0) {
    const auto redirect = [](const std::string& file, int to) {
      const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      return fd >= 0 && dup2(fd, to) >= 0;
    };
    if (!redirect(out, STDOUT_FILENO) || !redirect(err, STDERR_FILENO)) _exit(127);
    if (chdir(folder.c_str()) != 0) _exit(127);
    alarm(seconds);
    execv(argv.front(), argv.data());
    _exit(127);
  }
  int status = 0;
  bool ended = false;
  while (!interruption.after.empty() && !ended) {
    if (Scratch::Text(err).find(interruption.after) != std::string::npos) {
      kill(child, interruption.signal);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ended = waitpid(child, &status, WNOHANG) == child;
  }
  if (!ended) waitpid(child, &status, 0);
  Finished finished;
  if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
  finished.out = Scratch::Text(out);
  finished.err = Scratch::Text(err);
  return finished;
}

}  // namespace continuum::testing
