#include <algorithm>

#include <fmt/core.h>

#include "sim/check.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;

const char* Name(Severity severity) {
  return severity == Severity::kError     ? "error"
         : severity == Severity::kWarning ? "warning"
                                          : "info";
}

std::string Counted(std::ptrdiff_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string Line(const Finding& f) {
  const std::string channel = f.channel.empty() ? "" : f.channel + ": ";
  return fmt::format("  {:<8}{:<16} {}{}\n", Name(f.severity), f.what, channel, f.text);
}

}  // namespace

std::string Report(const std::vector<Finding>& findings) {
  const auto count = [&](Severity severity) {
    return std::count_if(findings.begin(), findings.end(),
                         [&](const Finding& f) { return f.severity == severity; });
  };
  std::vector<std::string> logs;
  for (const Finding& f : findings) {
    if (std::find(logs.begin(), logs.end(), f.log) == logs.end()) logs.push_back(f.log);
  }
  std::string text = fmt::format("{}, {}, {}\n", Counted(count(Severity::kError), "error"),
                                 Counted(count(Severity::kWarning), "warning"),
                                 Counted(count(Severity::kInfo), "note"));
  for (const std::string& log : logs) {
    text += log.empty() ? "experiment\n" : "log " + log + "\n";
    for (const Severity severity : {Severity::kError, Severity::kWarning, Severity::kInfo}) {
      for (const Finding& f : findings) {
        if (f.log == log && f.severity == severity) text += Line(f);
      }
    }
  }
  return text;
}

nlohmann::json ToJson(const std::vector<Finding>& findings) {
  auto list = nlohmann::json::array();
  for (const Finding& f : findings) {
    list.push_back({{"log", f.log},
                    {"channel", f.channel},
                    {"what", f.what},
                    {"text", f.text},
                    {"begin", f.begin},
                    {"end", f.end},
                    {"severity", Name(f.severity)}});
  }
  return list;
}

}  // namespace continuum
