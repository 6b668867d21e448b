#include "identification/study/row_run.h"

#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "identification/study/row_folder.h"
#include "identification/study/row_result.h"
#include "sim/io/child_process.h"
#include "sim/io/file.h"
#include "sim/io/host_name.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using State = RowStatus::State;

constexpr char kMessages[] = "messages.txt", kPrinted[] = "output.txt";

ChildCommand CommandOf(const StudyTable& study, const StudyRow& row, const StudyRun& run,
                       const fs::path& folder) {
  std::string experiment = row.experiment;
  if (experiment.starts_with('-')) experiment.insert(0, "./");
  ChildCommand command{{run.program, row.command, experiment}, study.folder, folder / kPrinted};
  if (row.command == "check") {
    command.words.emplace_back("--json");
    command.output = folder / kFindings;
  } else {
    command.words.insert(command.words.end(), {"--out", folder.string()});
  }
  command.words.insert(command.words.end(), row.options.begin(), row.options.end());
  return command;
}

void ReplaceAll(const std::string& old, const std::string& by, std::string& text) {
  for (std::size_t at = 0; (at = text.find(old, at)) != text.npos; at += by.size())
    text.replace(at, old.size(), by);
}

// The tool's last message: "continuum: ...".
std::string ReasonIn(const std::string& messages) {
  std::string reason, last;
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("continuum: ")) reason = line.substr(std::string("continuum: ").size());
    if (!line.empty()) last = line;
  }
  return reason.empty() ? last : reason;
}

// As after the option --help.
std::string WhyNoResult(const fs::path& folder, const std::string& command) {
  try {
    ReadResult(folder, command);
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

std::string WhyFailed(const ChildEnd& end) {
  if (end.signal != 0) return end.InWords();
  const std::string reason = ReasonIn(end.messages);
  return reason.empty() ? fmt::format("exit code {}", end.exit_code) : reason;
}

class OneRow {
 public:
  OneRow(const StudyTable& study, const StudyRow& row, const StudyRun& run, RowStatus status)
      : study_(study), row_(row), run_(run), status_(std::move(status)) {}

  RowStatus Run(const Progress& outer) {
    RowRecord record{*status_.inputs, "", -1, 0, 0, 0, HostName()};
    try {
      RowFolder aside(run_.out, row_.name);
      const ChildEnd end = RunIn(aside.path(), outer);
      if (end.stopped || StopRequested()) return status_;
      record.exit_code = end.exit_code;
      record.seconds = end.seconds;
      record.processor_seconds = end.processor_seconds;
      record.peak_megabytes = end.peak_megabytes;
      record.reason = end.exit_code == 0 ? WhyNoResult(aside.path(), row_.command) : WhyFailed(end);
      Finish(aside, end, record);
    } catch (const Error& e) {
      record.reason = e.what();
      RecordFailure(record);
    }
    return status_;
  }

 private:
  ChildEnd RunIn(const fs::path& folder, const Progress& outer) {
    const auto say = [&](const std::string& line) {
      Progress now = outer;
      now.at = line.empty() ? row_.name : row_.name + ": " + line;
      if (run_.progress) run_.progress(now);
    };
    say("");
    return RunChild(CommandOf(study_, row_, run_, folder), say);
  }

  // What was printed names the place that the folder will have.
  void Finish(RowFolder& aside, const ChildEnd& end, RowRecord record) {
    const bool done = record.reason.empty();
    const std::string name = done ? row_.name : FailedName(row_);
    const auto renamed = [&](std::string text) {
      ReplaceAll(aside.path().string(), (run_.out / name).string(), text);
      return text;
    };
    record.reason = renamed(record.reason);
    const fs::path printed = aside.path() / kPrinted;
    if (fs::exists(printed)) WriteFile(printed, renamed(ReadFile(printed)));
    if (!end.messages.empty()) WriteFile(aside.path() / kMessages, renamed(end.messages));
    WriteRecord(record, aside.path());
    aside.Become(name);
    if (done) {
      std::error_code ignored;
      fs::remove_all(run_.out / FailedName(row_), ignored);
    }
    Say(record);
  }

  // Without what the run wrote, which there may be no room for.
  void RecordFailure(const RowRecord& record) {
    Say(record);
    try {
      RowFolder aside(run_.out, row_.name);
      WriteRecord(record, aside.path());
      aside.Become(FailedName(row_));
    } catch (const Error&) {  // the reason is in the status, all the same
    }
  }

  void Say(const RowRecord& record) {
    status_.state = record.reason.empty() ? State::kDone : State::kFailed;
    status_.reason = record.reason.empty() ? "" : row_.where + ": " + record.reason;
    status_.record = record;
  }

  const StudyTable& study_;
  const StudyRow& row_;
  const StudyRun& run_;
  RowStatus status_;
};

}  // namespace

RowStatus RunRow(const StudyTable& study, const StudyRow& row, const StudyRun& run,
                 const RowStatus& before, const Progress& outer) {
  return OneRow(study, row, run, before).Run(outer);
}

}  // namespace continuum
