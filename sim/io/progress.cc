#include "sim/io/progress.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace continuum {
namespace {

std::string Steps(const Progress& p) {
  if (p.of == 0) return p.done > 0 ? fmt::format(", {} done", p.done) : "";
  return fmt::format(", {} of {}", p.done, p.of);
}

// In numbers that claim no more than is known.
std::string About(double seconds) {
  if (seconds < 1) return "a second";
  if (seconds < 10) return fmt::format("{:.0f} s", seconds);
  if (seconds < 90) return fmt::format("{:.0f} s", 5 * std::round(seconds / 5));
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

// Whole characters of UTF-8, so that a line that is rewritten stays one.
std::string Cut(std::string text, std::size_t width) {
  if (text.size() <= width) return text;
  while (width > 0 && (static_cast<unsigned char>(text[width]) & 0xC0) == 0x80) --width;
  text.resize(width);
  return text;
}

}  // namespace

ProgressCallback Within(const Progress& outer, const ProgressCallback& callback) {
  if (!callback) return {};
  return [outer, callback](const Progress& inner) {
    Progress whole = outer;
    whole.at += (outer.at.empty() ? "" : ", ") + inner.stage + Steps(inner);
    if (!inner.at.empty()) whole.at += ": " + inner.at;
    callback(whole);
  };
}

void ProgressText::Follow(const Progress& p, double now) {
  if (p.stage == first_.stage && p.of == first_.of && p.done >= first_.done) return;
  first_ = p, began_ = now;
}

std::string ProgressText::TimeLeft(const Progress& p, double now) const {
  constexpr double kTooEarly = 0.5;  // s
  if (p.of <= p.done || p.done <= first_.done || now - began_ < kTooEarly) return "";
  const double each = (now - began_) / static_cast<double>(p.done - first_.done);
  return ", about " + About(each * static_cast<double>(p.of - p.done)) + " more";
}

std::string ProgressText::Line(const Progress& p, double now, std::size_t width) {
  Follow(p, now);
  std::string line = p.number > 0 ? fmt::format("{}/{} ", p.number, p.last) : "";
  line += p.stage + Steps(p) + TimeLeft(p, now);
  if (!p.at.empty()) line += ": " + p.at;
  return Cut(std::move(line), width);
}

std::string ProgressText::Beginning(const Progress& p) {
  if (!begun_.insert(p.stage).second) return "";
  return p.of > 1 ? fmt::format("{} ({} steps)", p.stage, p.of) : p.stage;
}

}  // namespace continuum
