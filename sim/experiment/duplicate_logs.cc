#include "sim/experiment/duplicate_logs.h"

#include <algorithm>
#include <filesystem>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

bool SameFile(const Log& a, const Log& b) {
  std::error_code ignored;
  return a.variable == b.variable && std::filesystem::equivalent(a.file, b.file, ignored);
}

// As in the file [s], first to last row; the times of windows that touch are not shared.
bool ShareRows(const Log& a, const Log& b) {
  if (a.window.empty() || b.window.empty()) return true;
  return std::max(a.window[0], b.window[0]) < std::min(a.window[1], b.window[1]);
}

std::string Described(const Log& log) {
  std::string text = log.file.filename().string();
  if (!log.window.empty())
    text += ", window [" + Decimal(log.window[0]) + ", " + Decimal(log.window[1]) + "]";
  return text;
}

}  // namespace

void RefuseRepeatedLogs(const std::vector<Log>& logs, const std::vector<std::string>& where) {
  for (std::size_t b = 0; b < logs.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!SameFile(logs[a], logs[b]) || !ShareRows(logs[a], logs[b])) continue;
      throw Error::Input(where[b], "rows that no other log has",
                         Described(logs[b]) + ", as in " + where[a] + " (" + Described(logs[a]) +
                             "); one file needs windows that do not overlap");
    }
  }
}

}  // namespace continuum
