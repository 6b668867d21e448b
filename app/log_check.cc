#include "app/log_check.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/check/check.h"
#include "sim/check/finding_groups.h"

namespace continuum {

void PrintLogCheck(const std::string& file, const Experiment& e) {
  constexpr std::size_t kLines = 4;
  std::size_t more = 0, printed = 0;
  const auto findings = CheckLogs(e);
  for (const FindingGroup& g : Grouped(findings)) {
    const auto severity = g.members.front()->severity;
    if (severity == Finding::Severity::kInfo) continue;
    const bool constant = g.members.front()->what == "no_variance";
    if (severity == Finding::Severity::kWarning && printed >= kLines && !constant) {
      ++more;
      continue;
    }
    ++printed;
    std::string where = g.logs.size() > 1 && g.logs.size() == e.logs.size()
                            ? "all logs"
                            : fmt::format("{}", fmt::join(g.logs, ", "));
    for (const std::string& channel : g.channels)
      where += channel.empty() ? "" : ", column '" + channel + "'";
    if (!where.empty()) where += ": ";
    std::fprintf(stderr, "log check: %s%s\n", where.c_str(), g.text.c_str());
  }
  if (more > 0)
    std::fprintf(stderr, "log check: %zu more warnings: continuum check %s\n", more, file.c_str());
}

}  // namespace continuum
