#include "support/child.h"

#include <execinfo.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "support/scratch.h"

namespace continuum::testing {
namespace {

int trace_to = -1;  // a file

void WriteTrace(int signal) {
  std::array<void*, 40> frames;
  const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
  backtrace_symbols_fd(frames.data(), count, trace_to);
  raise(signal);  // the handler is gone
}

void CatchCrashes(const std::string& file) {
  trace_to = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  struct sigaction action = {};
  action.sa_handler = WriteTrace;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGALRM, SIGXCPU})
    sigaction(signal, &action, nullptr);
  std::array<void*, 1> first;
  backtrace(first.data(), 1);  // loads what it needs, which a crash may not be able to
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

Ended InChild(const std::function<std::string()>& work, unsigned limit, unsigned waits) {
  const Scratch scratch;
  const std::string trace = scratch / "trace", result = scratch / "result";
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    CatchCrashes(trace);
    const rlimit time{limit, limit + 1};
    setrlimit(RLIMIT_CPU, &time);
    alarm(waits * limit);
    std::ofstream(result) << work();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  Ended ended;
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  ended.too_long = ended.signal == SIGALRM || ended.signal == SIGXCPU;
  ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ended.text = Scratch::Text(result);
  ended.trace = LinesOf(Scratch::Text(trace));
  return ended;
}

}  // namespace continuum::testing
