#include "identification/study/row_status.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "identification/study/row_result.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using State = RowStatus::State;

// Something that lies in a row's place and is no result.
bool IsOccupied(const fs::path& place) {
  std::error_code failed;
  return fs::exists(place, failed) &&
         (!fs::is_directory(place, failed) || !fs::is_empty(place, failed));
}

// What stands in a row's place instead of its result.
std::string Other(const std::optional<RowRecord>& old, const std::optional<RowRecord>& failed,
                  const RowInputs& now) {
  if (!old) return "is no result of a row; move it away";
  const std::string changes = ChangesBetween(old->inputs, now);
  return "holds the result of other inputs (" + changes + ")" +
         (failed ? ", and the present ones failed (" + failed->reason + ")" : "") +
         "; `--again` replaces it";
}

}  // namespace

const char* StateName(State state) {
  switch (state) {
    case State::kDone:
      return "done";
    case State::kFailed:
      return "failed";
    case State::kChanged:
      return "changed";
    case State::kMissing:
      break;
  }
  return "missing";
}

std::string CountsInWords(const std::vector<State>& rows) {
  std::string text;
  for (const State s : {State::kDone, State::kFailed, State::kChanged, State::kMissing}) {
    const auto count = std::count(rows.begin(), rows.end(), s);
    if (count > 0) text += fmt::format("{} {} {}", text.empty() ? "" : ",", count, StateName(s));
  }
  return fmt::format("{} row{}:{}", rows.size(), rows.size() == 1 ? "" : "s", text);
}

std::string FailedName(const StudyRow& row) { return row.name + ".failed"; }

bool MayRun(const RowStatus& status, bool again) {
  if (!status.inputs || status.state == State::kDone) return false;
  return status.state != State::kChanged || (again && status.record);
}

RowStatus StatusOf(const StudyTable& study, const StudyRow& row, const fs::path& out,
                   const std::string& version, FileHashes& hashes) {
  RowStatus s;
  const auto say = [&](State state, std::string reason, std::optional<RowRecord> record) {
    s.state = state;
    s.reason = std::move(reason);
    s.record = std::move(record);
    return s;
  };
  if (!row.fault.empty()) return say(State::kFailed, row.fault, {});
  try {
    s.inputs = InputsOf(study, row, version, hashes);
  } catch (const Error& e) {
    return say(State::kFailed, e.what(), {});
  }
  const fs::path place = out / row.name;
  auto old = ReadRecord(place);
  if (old && old->inputs == *s.inputs) {
    const fs::path result = place / ResultFile(row.command);
    std::error_code unseen;
    if (fs::exists(result, unseen)) return say(State::kDone, "", std::move(old));
    return say(State::kMissing, row.where + ": " + result.string() + " is gone", {});
  }
  auto failed = ReadRecord(out / FailedName(row));
  if (failed && !(failed->inputs == *s.inputs)) failed.reset();
  if (old || IsOccupied(place)) {
    const std::string reason =
        row.where + ": " + place.string() + " " + Other(old, failed, *s.inputs);
    return say(State::kChanged, reason, std::move(old));
  }
  if (failed) {
    const std::string reason = row.where + ": " + failed->reason;
    return say(State::kFailed, reason, std::move(failed));
  }
  return s;
}

// Of the inputs a record without a run.
std::string ToMessage(const RowStatus& s) {
  nlohmann::json json{{"state", s.state}, {"reason", s.reason}};
  if (s.inputs) json["inputs"] = ToJson(RowRecord{.inputs = *s.inputs, .reason = "", .host = ""});
  if (s.record) json["record"] = ToJson(*s.record);
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

RowStatus StatusFrom(const std::string& message) {
  const auto json = nlohmann::json::parse(message);
  RowStatus s{json.at("state"), json.at("reason"), {}, {}};
  if (json.contains("inputs")) s.inputs = RecordFrom(json["inputs"]).inputs;
  if (json.contains("record")) s.record = RecordFrom(json["record"]);
  return s;
}

}  // namespace continuum
