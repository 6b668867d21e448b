#include "app/study.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/console.h"
#include "app/rank_job.h"
#include "error.h"
#include "identification/study/row_folder.h"
#include "identification/study/row_run.h"
#include "identification/study/row_selection.h"
#include "identification/study/study_table.h"
#include "identification/study/summary.h"
#include "sim/io/file.h"
#include "sim/io/interrupt.h"
#include "sim/io/output_folder.h"
#include "sim/numerics/ranks.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using State = RowStatus::State;

constexpr int kNotAllDone = 3;  // exit code: the study ran, and some of its rows are not done

struct Options {
  std::vector<std::string> sources;
  std::string out, rows, shard;
  StudyDefaults defaults;
  bool again = false, summary = false, list = false;
};

StudyRun RunOf(const Options& o) {
  std::error_code unknown;
  return {fs::read_symlink("/proc/self/exe", unknown), fs::absolute(o.out).lexically_normal(),
          CONTINUUM_VERSION, ShowProgress};
}

// "row 3/40  arm-diagnose   done      named (sure): dahl at joint hinge, gain 64 % [60, 68]".
void Print(const StudyTable& study, const StudyRow& row, const RowStatus& status,
           const fs::path& out) {
  std::string text = status.reason;
  try {
    if (status.state == State::kDone) text = InWords(ReadResult(out / row.name, row.command));
  } catch (const Error& e) {
    text = e.what();
  }
  EndProgress();
  std::printf("row %zu/%zu  %-24s %-8s %s\n", row.number, study.rows.size(), row.name.c_str(),
              StateName(status.state), text.c_str());
  std::fflush(stdout);  // before minutes of the next row
}

void PrintList(const StudyTable& study, const std::vector<std::size_t>& rows) {
  for (const std::size_t r : rows) std::printf("%s\n", study.rows[r].name.c_str());
}

// The rows of a run, shared between the ranks.
class Rows {
 public:
  Rows(const StudyTable& study, const std::vector<std::size_t>& rows, StudyRun run, bool again)
      : study_(study), rows_(rows), run_(std::move(run)), again_(again), all_(rows.size()) {
    run_.progress = [this](const Progress& progress) {
      const std::lock_guard lock(console_);
      ShowProgress(progress);
    };
  }

  // How all of these stand, as rank 0 knows. Throws Error when the user asked to stop, or mpirun
  // did as a rank is gone.
  const std::vector<RowStatus>& Run() {
    const auto work = [&](std::size_t i) { return RunOne(i); };
    HandOut(rows_.size(), work, [&](std::size_t i, const std::string& m) { Take(i, m); });
    EndProgress();
    return all_;
  }
  const std::vector<RowStatus>& all() const { return all_; }

 private:
  // A mark where it is news, and the status.
  std::string RunOne(std::size_t i) {
    const StudyRow& row = study_.rows[rows_[i]];
    RowStatus status = StatusOf(study_, row, run_.out, run_.version, hashes_);
    const bool was_done = status.state == State::kDone;
    if (MayRun(status, again_))
      status = RunRow(study_, row, run_, status, {"study", done_, rows_.size(), row.name});
    return (was_done || StopRequested() ? kNoNews : kNews) + ToMessage(status);
  }

  void Take(std::size_t i, const std::string& message) {
    const StudyRow& row = study_.rows[rows_[i]];
    all_[i] = StatusFrom(message.substr(kNews.size()));
    ++done_;
    const std::lock_guard lock(console_);
    if (message.starts_with(kNews)) Print(study_, row, all_[i], run_.out);
    if (RankCount() > 1) ShowProgress({"study", done_, rows_.size(), row.name});
  }

  inline static const std::string kNews = "+", kNoNews = "-";

  const StudyTable& study_;
  const std::vector<std::size_t>& rows_;
  StudyRun run_;
  const bool again_;
  FileHashes hashes_;
  std::mutex console_;
  std::vector<RowStatus> all_;
  std::atomic<std::size_t> done_ = 0;
};

std::vector<RowStatus> LookAtAll(const StudyTable& study, const StudyRun& run) {
  FileHashes hashes;
  std::vector<RowStatus> all;
  for (const StudyRow& row : study.rows)
    all.push_back(StatusOf(study, row, run.out, run.version, hashes));
  return all;
}

void PrintSummary(const StudyTable& study, std::vector<RowStatus> all, const fs::path& out) {
  const StudySummary summary = Summarise(study, std::move(all), out);
  WriteSummary(summary, out);
  for (const Population& p : summary.populations) {
    const auto odd = OddUnits(p, summary.lines);
    std::printf("%s of %zu units: %.4g %s, %.2g between units%s\n", p.name.c_str(), p.units.size(),
                p.spread.mean, p.unit.c_str(), p.spread.between,
                odd.empty() ? "" : fmt::format("; odd: {}", fmt::join(odd, ", ")).c_str());
  }
  std::printf("report: %s\n", (out / "study.html").c_str());
}

std::vector<State> StatesOf(const std::vector<RowStatus>& rows) {
  std::vector<State> states;
  for (const RowStatus& status : rows) states.push_back(status.state);
  return states;
}

// Says what stands also where it comes to no end.
std::vector<RowStatus> RunRows(const StudyTable& study, const std::vector<std::size_t>& which,
                               const StudyRun& run, bool again) {
  Rows rows(study, which, run, again);
  try {
    return rows.Run();
  } catch (const Error&) {
    EndProgress();
    if (ThisRank() == 0) std::printf("%s\n", CountsInWords(StatesOf(rows.all())).c_str());
    std::fflush(stdout);
    throw;
  }
}

// The first rank looks at the folder for all; they must then see the same rows.
void Prepare(const StudyTable& study, const StudyRun& run,
             const std::vector<std::string>& sources) {
  if (ThisRank() == 0) {
    MakeFolder(run.out);
    for (const char* const file : {"study.csv", "study.json", "study.html"})
      RequireWritable(run.out / file, {sources.begin(), sources.end()});
  }
  std::vector<std::string> names;
  for (const StudyRow& row : study.rows) names.push_back(row.name);
  RequireSameOnRanks("rows of the study", fmt::format("{}", fmt::join(names, ", ")));
  RemoveLeftBehind(run.out);
}

int RunStudy(const Options& o) {
  const StudyTable study = ReadStudy(o.sources, o.defaults);
  const auto rows = SelectRows(study, o.rows, o.shard);
  if (o.list) {
    PrintList(study, rows);
    return 0;
  }
  if (o.out.empty()) throw Error::Input("--out", "a folder for the results", "nothing");
  const StudyRun run = RunOf(o);
  Prepare(study, run, o.sources);
  std::vector<RowStatus> all;
  if (!o.summary) all = RunRows(study, rows, run, o.again);
  if (!GoOnAlone()) return 0;
  if (o.summary) all = LookAtAll(study, run);
  const auto states = StatesOf(all);
  const bool done =
      std::all_of(states.begin(), states.end(), [](State state) { return state == State::kDone; });
  std::printf("%s\n", CountsInWords(states).c_str());
  const bool whole = o.rows.empty() && o.shard.empty();
  if (whole || o.summary) PrintSummary(study, std::move(all), run.out);
  return done ? 0 : kNotAllDone;
}

}  // namespace

void AddStudy(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<Options>();
  CLI::App* const sub = app.add_subcommand(
      "study", "Run many experiments, each in a folder of its own; what is done is not run again");
  sub->add_option("study", o->sources,
                  "STUDY.csv or STUDY.yaml (a table of rows), or experiment files; a pattern in "
                  "quotes gives a row for each file")
      ->required();
  sub->add_option("--out", o->out,
                  "folder for a folder of each row, study.html, study.csv, study.json");
  sub->add_option("--command", o->defaults.command,
                  "check, replay, identify or diagnose, for rows that do not say it")
      ->check(CLI::IsMember(RowCommands()));
  sub->add_option("--options", o->defaults.options,
                  "options of that command, for rows that do not say them");
  sub->add_option("--rows", o->rows, "only these: numbers, ranges and names, as 17:32 or 3,arm");
  sub->add_option("--shard", o->shard, "only every N-th row from the K-th on, as K/N, K from 1");
  sub->add_flag("--again", o->again,
                "also run rows whose inputs changed, and replace their results");
  auto* const summary = sub->add_flag("--summary", o->summary, "run nothing, write the summary");
  sub->add_flag("--list", o->list, "print the names of the rows, and nothing else")
      ->excludes(summary);
  sub->footer(
      "Exit codes: 0 all rows are done, 3 some are not, 1 interrupted, 2 wrong use.\n"
      "Example:\n  continuum study study.csv --out out");
  sub->callback([o, &exit_code] { exit_code = RunStudy(*o); });
}

}  // namespace continuum
