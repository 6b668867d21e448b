#include "app/log_check.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/check/check.h"
#include "sim/check/finding_groups.h"

namespace continuum {

namespace {

void Print(const std::string& file, const Experiment& e, const std::vector<Finding>& findings) {
  constexpr std::size_t kLines = 4;
  std::size_t more = 0, printed = 0;
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

// A mistake in the columns, which no effect of a model explains.
bool IsOfColumns(const Finding& finding) {
  constexpr std::array<std::string_view, 4> kKinds{"unit_suspect", "sign_suspect", "swapped",
                                                   "unlike"};
  return std::find(kKinds.begin(), kKinds.end(), finding.what) != kKinds.end();
}

}  // namespace

void PrintLogCheck(const std::string& file, const Experiment& e) { Print(file, e, CheckLogs(e)); }

void PrintLogCheck(const std::string& file, const Experiment& e, const ModelSpec& system) {
  std::vector<Finding> findings = CheckAgainstModel(e, system);
  std::erase_if(findings, [](const Finding& one) { return !IsOfColumns(one); });
  std::vector<Finding> of_logs = CheckLogs(e);
  findings.insert(findings.end(), of_logs.begin(), of_logs.end());
  Print(file, e, findings);
}

}  // namespace continuum
