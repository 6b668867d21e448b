#include "identification/report/parts.h"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"

namespace continuum {
namespace {

void AddBadge(Page& page, const MissingPart& part) {
  page.Badge(Tone::kWarn, "Not in this report: " + part.name, part.why);
}

}  // namespace

void AddPart(Page& page, const std::string& name, std::vector<MissingPart>& missing,
             const std::function<void()>& content) {
  Page before = page;
  if (MakePart(name, missing, content)) return;
  page = std::move(before);  // without what was written of the part
  AddBadge(page, missing.back());
}

void AddMissing(Page& page, const std::string& name, const std::vector<MissingPart>& missing) {
  for (const MissingPart& part : missing)
    if (part.name == name) AddBadge(page, part);
}

void AddMissing(nlohmann::json& json, const std::vector<MissingPart>& missing) {
  for (const MissingPart& part : missing) json["missing"].push_back(part.InWords());
}

std::string MissingInWords(const std::vector<MissingPart>& missing) {
  std::string text;
  for (const MissingPart& part : missing) {
    const std::string line = "not in the report: " + part.InWords() + "\n";
    if (text.find(line) == text.npos) text += line;  // of several files
  }
  return text;
}

void RequireCount(const std::string& what, std::size_t found, std::size_t expected) {
  if (found != expected) throw Error::Job(fmt::format("{}: {} of {}", what, found, expected));
}

void RequireWhole(const Experiment& e, const std::vector<Trace>& logs) {
  RequireCount("simulated logs", logs.size(), e.logs.size());
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const auto& channels = logs[l].channel;
    const std::string of = "log '" + e.logs[l].label + "', simulated ";
    RequireCount(of + "channels", channels.size(), e.channels.size());
    for (const auto& channel : channels)
      RequireCount(of + "rows", channel.size(), e.logs[l].rows());
  }
}

void RequireWhole(const Experiment& e, const std::vector<Replayed>& logs) {
  std::vector<Trace> traces;
  for (const Replayed& log : logs) traces.push_back(log.trace);
  RequireWhole(e, traces);
}

}  // namespace continuum
