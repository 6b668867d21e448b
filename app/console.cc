#include "app/console.h"

#include <unistd.h>

#include <charconv>
#include <cstdio>

#include <fmt/format.h>

namespace continuum {
namespace {

bool open_line = false;

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
  return Within(fmt::format("a number in [{:g}, {:g}]", lower, upper), lower, upper);
}

CLI::Validator WholeNumberWithin(std::uint64_t lower, std::uint64_t upper) {
  return Within(fmt::format("a whole number in [{}, {}]", lower, upper), lower, upper);
}

}  // namespace continuum
