#include "app/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <mutex>

#include <fmt/format.h>

#include "sim/numerics/ranks.h"

namespace continuum {
namespace {

bool open_line = false;

// Of the terminal on stderr.
std::size_t Columns() {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : kUsual;
}

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Number>
CLI::Validator Within(const std::string& range, Number lower, Number upper) {
  const auto check = [=](const std::string& text) {
    Number value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    const bool good = error == std::errc{} && end == last && lower <= value && value <= upper;
    return good ? std::string() : "expected " + range + ", found '" + text + "'";
  };
  return {check, "", "NUMBER"};
}

}  // namespace

void ShowProgress(const Progress& progress) {
  if (ThisRank() > 0) return;
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  static ProgressText text;
  if (isatty(STDERR_FILENO)) {
    const std::string line = text.Line(progress, Now(), Columns() - 1);
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    open_line = true;
  } else if (const std::string line = text.Beginning(progress); !line.empty()) {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
}

void EndProgress() {
  if (open_line) std::fprintf(stderr, "\n");
  open_line = false;
}

CLI::Validator NumberWithin(double lower, double upper) {
  return Within(fmt::format("a number in [{:g}, {:g}]", lower, upper), lower, upper);
}

CLI::Validator WholeNumberWithin(std::uint64_t lower, std::uint64_t upper) {
  return Within(fmt::format("a whole number in [{}, {}]", lower, upper), lower, upper);
}

}  // namespace continuum
