#include "sim/io/time_stamp.h"

#include <chrono>
#include <cstdint>

namespace continuum {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Takes pieces off the beginning of a text; what is not there leaves the text as it is.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  bool done() const { return text_.empty(); }
  bool Take(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  // A whole number of exactly so many digits.
  std::optional<int> Digits(std::size_t count) {
    int value = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (k >= text_.size() || !IsDigit(text_[k])) return {};
      value = 10 * value + (text_[k] - '0');
    }
    text_.remove_prefix(count);
    return value;
  }
  // Nanoseconds of the digits after a point; digits beyond these are dropped.
  std::int64_t Fraction() {
    std::int64_t value = 0, size = 1'000'000'000;
    while (!text_.empty() && IsDigit(text_.front())) {
      size /= 10;
      value += size * (text_.front() - '0');
      text_.remove_prefix(1);
    }
    return value;
  }

 private:
  std::string_view text_;
};

constexpr std::int64_t kSecond = 1'000'000'000;  // ns

// "12:00:00.01"; the seconds may be missing.
std::optional<std::int64_t> TimeOfDay(Scanner& s) {
  const auto hour = s.Digits(2);
  if (!hour || *hour > 23 || !s.Take(':')) return {};
  const auto minute = s.Digits(2);
  if (!minute || *minute > 59) return {};
  std::int64_t time = kSecond * 60 * (60 * *hour + *minute);
  if (!s.Take(':')) return time;
  const auto second = s.Digits(2);
  if (!second || *second > 60) return {};
  time += kSecond * *second;
  if (s.Take('.') || s.Take(',')) time += s.Fraction();
  return time;
}

// "2024-05-01", as nanoseconds since 1970.
std::optional<std::int64_t> Date(Scanner& s) {
  const auto year = s.Digits(4);
  if (!year || *year < 1900 || *year > 2200 || !(s.Take('-') || s.Take('/'))) return {};
  const auto month = s.Digits(2);
  if (!month || !(s.Take('-') || s.Take('/'))) return {};
  const auto day = s.Digits(2);
  if (!day) return {};
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) return {};
  return kSecond * 86400 * std::chrono::sys_days(date).time_since_epoch().count();
}

// "Z", "+02:00", "+0200", "+02" or nothing.
std::optional<std::int64_t> Zone(Scanner& s) {
  if (s.done() || s.Take('Z') || s.Take('z')) return 0;
  const int sign = s.Take('+') ? 1 : s.Take('-') ? -1 : 0;
  const auto hours = s.Digits(2);
  if (sign == 0 || !hours) return {};
  s.Take(':');
  return sign * kSecond * 60 * (60 * *hours + s.Digits(2).value_or(0));
}

}  // namespace

std::optional<long double> SecondsOfStamp(std::string_view text) {
  const auto seconds = [](std::int64_t ns) { return static_cast<long double>(ns) / kSecond; };
  Scanner clock(text);
  if (const auto time = TimeOfDay(clock); time && clock.done()) return seconds(*time);
  Scanner s(text);
  const auto date = Date(s);
  if (!date || !(s.Take('T') || s.Take('t') || s.Take(' '))) return {};
  const auto time = TimeOfDay(s);
  if (!time) return {};
  const auto zone = Zone(s);
  if (!zone || !s.done()) return {};
  return seconds(*date + *time - *zone);
}

}  // namespace continuum
