#include "app/console.h"

#include <unistd.h>

#include <charconv>
#include <cstdio>

#include <fmt/format.h>

namespace continuum {
namespace {
bool open_line = false;
}

void ShowProgress(const std::string& text) {
  if (isatty(STDERR_FILENO)) {
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    open_line = true;
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
  std::fflush(stderr);
}

void EndProgress() {
  if (open_line) std::fprintf(stderr, "\n");
  open_line = false;
}

CLI::Validator NumberWithin(double lower, double upper) {
  const std::string range = fmt::format("a number in [{:g}, {:g}]", lower, upper);
  const auto check = [=](const std::string& text) {
    double value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    const bool good = error == std::errc{} && end == last && lower <= value && value <= upper;
    return good ? std::string() : "expected " + range + ", found '" + text + "'";
  };
  return {check, "", "NUMBER"};
}

}  // namespace continuum
