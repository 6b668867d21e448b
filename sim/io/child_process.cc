#include "sim/io/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

constexpr int kCannotStart = 127;  // exit code, as a shell's

// A file descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  ~Descriptor() { Close(); }
  int get() const { return fd_; }
  void Close() {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

[[noreturn]] void Refuse(const std::string& what) {
  throw Error::Input(what, "a program that can be started", std::strerror(errno));
}

// In the child: only what is safe after fork.
[[noreturn]] void Become(char* const* words, const char* folder, int output, int messages,
                         pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotStart);  // it died meanwhile
  const int nothing = open("/dev/null", O_RDONLY);
  const bool wired = nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 &&
                     dup2(output, STDOUT_FILENO) >= 0 && dup2(messages, STDERR_FILENO) >= 0;
  if (wired && chdir(folder) == 0) execv(words[0], words);
  _exit(kCannotStart);
}

// Calls `line` for each whole line of a text that grows.
class Lines {
 public:
  explicit Lines(const std::function<void(const std::string&)>& line) : line_(line) {}
  void Look(const std::string& text) {
    for (std::size_t end = 0; (end = text.find('\n', begin_)) != text.npos; begin_ = end + 1)
      if (line_) line_(text.substr(begin_, end - begin_));
  }

 private:
  const std::function<void(const std::string&)>& line_;
  std::size_t begin_ = 0;
};

// Reads to the end; kills the group once the user asks to stop.
void Follow(int fd, pid_t child, ChildEnd& end, Lines lines) {
  constexpr int kLook = 100;  // ms between looks at StopRequested
  std::array<char, 4096> bytes{};
  for (;;) {
    if (StopRequested() && !end.stopped) {
      end.stopped = true;
      kill(-child, SIGKILL);
      kill(child, SIGKILL);  // before it had a group of its own
    }
    pollfd ready{fd, POLLIN, 0};
    if (poll(&ready, 1, kLook) <= 0) continue;
    const ssize_t count = read(fd, bytes.data(), bytes.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return;
    if (count < 0) continue;
    end.messages.append(bytes.data(), static_cast<std::size_t>(count));
    lines.Look(end.messages);
  }
}

double SecondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

void Wait(pid_t child, ChildEnd& end) {
  int status = 0;
  rusage used{};
  while (wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.processor_seconds = SecondsOf(used.ru_utime) + SecondsOf(used.ru_stime);
  end.peak_megabytes = static_cast<double>(used.ru_maxrss) * 1024 / 1e6;
}

}  // namespace

std::string ChildEnd::InWords() const {
  if (signal == 0) return "";
  return fmt::format("ended by signal {} ({}){}", signal, strsignal(signal),
                     signal == SIGKILL ? ": was there enough memory?" : "");
}

ChildEnd RunChild(const ChildCommand& command,
                  const std::function<void(const std::string& line)>& line) {
  std::vector<char*> words;
  for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0) Refuse(command.words.front());
  Descriptor from(ends[0]), to(ends[1]);
  Descriptor output(open(command.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (output.get() < 0)
    throw Error::Input(command.output.string(), "a writable file", std::strerror(errno));
  const std::string folder = command.folder.empty() ? "." : command.folder.string();
  const auto begin = std::chrono::steady_clock::now();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) Refuse(command.words.front());
  if (child == 0) Become(words.data(), folder.c_str(), output.get(), to.get(), parent);
  to.Close();
  ChildEnd end;
  Follow(from.get(), child, end, Lines(line));
  Wait(child, end);
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (end.exit_code == kCannotStart && end.messages.empty()) {
    throw Error::Input(command.words.front(), "a program that can be started in " + folder, "none");
  }
  return end;
}

}  // namespace continuum
