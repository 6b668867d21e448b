#include "sim/check/findings.h"

#include <cmath>

#include "sim/io/rounded.h"

namespace continuum {

void Findings::Add(Severity severity, const std::string& channel, const std::string& what,
                   const std::string& text) {
  const bool has_time = log_ && !log_->time.empty();
  Add(severity, channel, what, text, has_time ? log_->time.front() : 0,
      has_time ? log_->time.back() : 0);
}
void Findings::Add(Severity severity, const std::string& channel, const std::string& what,
                   const std::string& summary, double begin, double end,
                   const std::string& places) {
  findings_.push_back(
      {log_ ? log_->label : "", channel, what, summary + places, summary, begin, end, severity});
}

bool Findings::Has(const std::string& channel, const std::string& what) const {
  return std::any_of(findings_.begin(), findings_.end(), [&](const Finding& f) {
    return f.channel == channel && f.severity != Severity::kInfo &&
           (what.empty() || f.what == what);
  });
}

std::string Clock(double time) {
  return std::abs(time) < 1000 ? Significant(time, 4) + " s" : Fixed(time, 3) + " s";
}

std::string Amount(double value, const std::string& unit) {
  return Significant(value, 3) + (unit == "1" ? "" : " " + unit);
}

}  // namespace continuum
