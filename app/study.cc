#include "app/study.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/console.h"
#include "error.h"
#include "identification/study/row_folder.h"
#include "identification/study/row_run.h"
#include "identification/study/row_selection.h"
#include "identification/study/study_table.h"
#include "identification/study/summary.h"
#include "sim/io/file.h"
#include "sim/io/interrupt.h"
#include "sim/io/output_folder.h"

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

// Runs the rows in turn; returns how all of these stand.
std::vector<RowStatus> RunRows(const StudyTable& study, const std::vector<std::size_t>& rows,
                               const StudyRun& run, bool again, FileHashes& hashes) {
  std::vector<RowStatus> all;
  for (std::size_t i = 0; i < rows.size() && !StopRequested(); ++i) {
    const StudyRow& row = study.rows[rows[i]];
    RowStatus status = StatusOf(study, row, run.out, run.version, hashes);
    const bool was_done = status.state == State::kDone;
    if (MayRun(status, again))
      status = RunRow(study, row, run, status, {"study", i, rows.size(), row.name});
    if (!was_done && !StopRequested()) Print(study, row, status, run.out);
    all.push_back(std::move(status));
  }
  EndProgress();
  StopIfRequested();
  return all;
}

std::vector<RowStatus> LookAtAll(const StudyTable& study, const StudyRun& run, FileHashes& hashes) {
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

int RunStudy(const Options& o) {
  const StudyTable study = ReadStudy(o.sources, o.defaults);
  const auto rows = SelectRows(study, o.rows, o.shard);
  if (o.list) {
    PrintList(study, rows);
    return 0;
  }
  if (o.out.empty()) throw Error::Input("--out", "a folder for the results", "nothing");
  const StudyRun run = RunOf(o);
  MakeFolder(run.out);
  for (const char* const file : {"study.csv", "study.json", "study.html"})
    RequireWritable(run.out / file, {o.sources.begin(), o.sources.end()});
  RemoveLeftBehind(run.out);
  FileHashes hashes;
  const bool whole = o.rows.empty() && o.shard.empty();
  std::vector<RowStatus> all =
      o.summary ? LookAtAll(study, run, hashes) : RunRows(study, rows, run, o.again, hashes);
  std::vector<State> states;
  for (const RowStatus& status : all) states.push_back(status.state);
  const bool done =
      std::all_of(states.begin(), states.end(), [](State state) { return state == State::kDone; });
  std::printf("%s\n", CountsInWords(states).c_str());
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
