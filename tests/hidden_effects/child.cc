#include "hidden_effects/child.h"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

namespace continuum::hidden {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void Answer(const std::function<std::string()>& work, double limit, int out) {
  const auto seconds = static_cast<rlim_t>(std::ceil(limit));
  const rlimit processor{seconds, seconds + 1};
  setrlimit(RLIMIT_CPU, &processor);
  const std::string text = work();
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(out, text.data() + done, text.size() - done);
    if (n <= 0) _exit(1);
    done += static_cast<std::size_t>(n);
  }
  _exit(0);
}

// All that comes until the other end is closed; false: the time was up before.
bool ReadUntil(Clock::time_point end, int in, std::string& text) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd ready{in, POLLIN, 0};
    if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) <= 0) return false;
    char buffer[4096];
    const ssize_t n = read(in, buffer, sizeof buffer);
    if (n <= 0) return true;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

}  // namespace

ChildAnswer InChild(const std::function<std::string()>& work, double limit) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    Answer(work, limit, ends[1]);
  }
  close(ends[1]);
  ChildAnswer answer;
  std::string text;
  const auto end = Clock::now() + std::chrono::milliseconds(static_cast<long>(20'000 * limit));
  answer.late = !ReadUntil(end, ends[0], text);
  if (answer.late) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  answer.late |= WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (!answer.late && WIFEXITED(status) && WEXITSTATUS(status) == 0) answer.text = text;
  return answer;
}

}  // namespace continuum::hidden
