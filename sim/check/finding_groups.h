#pragma once

#include <string>
#include <vector>

#include "sim/check/findings.h"

namespace continuum {

/// Findings that say the same of several columns or logs: of one kind, and with the same words but
/// for their numbers.
struct FindingGroup {
  std::vector<const Finding*> members;      ///< in the order of the findings, at least one
  std::vector<std::string> logs, channels;  ///< of the members, each once
  std::string text;  ///< numbers that differ as a range, "4.6..5"; one member: its whole text
};

/// In the order of their first members, which point into findings.
std::vector<FindingGroup> Grouped(const std::vector<Finding>& findings);

}  // namespace continuum
