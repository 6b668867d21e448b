#include <algorithm>
#include <set>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "sim/check/check.h"
#include "sim/check/finding_groups.h"
#include "sim/check/findings.h"

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

struct Entry {
  std::string section, what, subject, text;
  Severity severity;

  std::string Line() const {
    const std::string of = subject.empty() ? "" : subject + ": ";
    return fmt::format("  {:<8}{:<16} {}{}\n", Name(severity), what, of, text);
  }
};

Entry EntryOf(const std::string& section, const Finding& f, const std::string& where,
              const std::string& text) {
  return {section, f.what, where, text, f.severity};
}

// More lines of one kind in a section than this become one.
constexpr std::size_t kLinesOfAKind = 3;

bool OfOneKind(const Entry& a, const Entry& b) {
  return a.section == b.section && a.what == b.what && a.severity == b.severity;
}

// What stands for many entries of one kind: the first, and what the others are of.
Entry Together(const std::vector<Entry>& of_kind) {
  constexpr std::size_t kNames = 8;
  std::set<std::string> names;
  for (std::size_t i = 1; i < of_kind.size(); ++i) {
    if (!of_kind[i].subject.empty()) names.insert(of_kind[i].subject);
  }
  std::string list;
  std::size_t named = 0;
  for (const std::string& name : names) {
    if (named++ < kNames) list += (list.empty() ? ": " : "; ") + name;
  }
  if (named > kNames) list += fmt::format("; and {} more", named - kNames);
  Entry entry = of_kind.front();
  entry.text += fmt::format(" ({} more of this kind{})", of_kind.size() - 1, list);
  return entry;
}

std::vector<Entry> Collapsed(const std::vector<Entry>& entries) {
  std::vector<Entry> collapsed;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::vector<Entry> of_kind;
    std::size_t first = entries.size();
    for (std::size_t j = 0; j < entries.size(); ++j) {
      if (!OfOneKind(entries[i], entries[j])) continue;
      first = std::min(first, j);
      of_kind.push_back(entries[j]);
    }
    if (of_kind.size() <= kLinesOfAKind) {
      collapsed.push_back(entries[i]);
    } else if (i == first) {
      collapsed.push_back(Together(of_kind));
    }
  }
  return collapsed;
}

std::string SectionOf(const std::string& log) { return log.empty() ? "experiment" : "log " + log; }

// What several logs have in common names them unless they are many, and where it comes first.
Entry EntryOf(const FindingGroup& group, std::size_t logs) {
  const Finding& first = *group.members.front();
  const std::string channels = fmt::format("{}", fmt::join(group.channels, ", "));
  if (group.logs.size() == 1) return EntryOf(SectionOf(first.log), first, channels, group.text);
  const std::string which = group.logs.size() == logs ? fmt::format("all {} logs", logs)
                            : group.logs.size() <= 3
                                ? fmt::format("{}", fmt::join(group.logs, ", "))
                                : fmt::format("{} of {} logs", group.logs.size(), logs);
  const std::size_t times = group.members.size();
  const bool everywhere = times == group.channels.size() * group.logs.size();
  const std::string in =
      everywhere ? " in " + which : fmt::format(", {} times in {}", times, which);
  const std::string where = channels.empty() ? which : channels + in;
  const std::string place =
      first.severity == Severity::kInfo
          ? ""
          : fmt::format("; first in {} at t = {}", first.log, Clock(first.begin));
  return EntryOf("several logs", first, where, group.text + place);
}

// The sections in the order of the findings, in each the worst first.
std::string Listed(const std::vector<Entry>& entries) {
  const auto count = [&](Severity severity) {
    return std::count_if(entries.begin(), entries.end(),
                         [&](const Entry& e) { return e.severity == severity; });
  };
  std::string text = fmt::format("{}, {}, {}\n", Counted(count(Severity::kError), "error"),
                                 Counted(count(Severity::kWarning), "warning"),
                                 Counted(count(Severity::kInfo), "note"));
  std::vector<std::string> sections;
  for (const Entry& e : entries) {
    if (std::find(sections.begin(), sections.end(), e.section) == sections.end())
      sections.push_back(e.section);
  }
  for (const std::string& section : sections) {
    text += section + "\n";
    for (const Severity severity : {Severity::kError, Severity::kWarning, Severity::kInfo}) {
      for (const Entry& e : entries) {
        if (e.section == section && e.severity == severity) text += e.Line();
      }
    }
  }
  return text;
}

}  // namespace

std::string Report(const std::vector<Finding>& findings) {
  std::set<std::string> logs;
  for (const Finding& f : findings) {
    if (!f.log.empty()) logs.insert(f.log);
  }
  std::vector<Entry> entries;
  for (const FindingGroup& group : Grouped(findings))
    entries.push_back(EntryOf(group, logs.size()));
  entries = Collapsed(entries);
  std::string text = Listed(entries);
  if (entries.size() < findings.size())
    text += fmt::format("{} findings in all: --all lists them one by one\n", findings.size());
  return text;
}

std::string FullReport(const std::vector<Finding>& findings) {
  std::vector<Entry> entries;
  for (const Finding& f : findings)
    entries.push_back(EntryOf(SectionOf(f.log), f, f.channel, f.text));
  return Listed(entries);
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
