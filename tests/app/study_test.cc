// ctest labels: slow
// `continuum study`: rows in folders of their own, whole or absent, and done once.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include <nlohmann/json.hpp>

#include "bench.h"
#include "page_example.h"
#include "sim/io/csv.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using testing::Finished;
using ::testing::HasSubstr;
using testing::kExperiment;
using testing::kLog;
using ::testing::Not;
using testing::PageExample;
using testing::Scratch;

constexpr char kOtherLog[] = "t,u,q\n0,0.1,0\n0.1,0.1,0.02\n0.2,0.1,0.05\n0.3,0.1,0.09\n";
constexpr char kRows[] =
    "experiment,command,name,robot\n"
    "experiment.yaml,check,look,old\n"
    "experiment.yaml,replay,before,old\n"
    "experiment.yaml,identify,fit,new\n";

class Studies : public testing::AppBench {
 protected:
  Studies() { files_.Write("study.csv", kRows); }

  Finished Study(std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"study", "study.csv", "--out", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return Run(words);
  }
  std::string Text(const std::string& file) const { return Scratch::Text(files_ / file); }
  nlohmann::json Json(const std::string& file) const { return nlohmann::json::parse(Text(file)); }
  std::vector<std::string> Statuses() const {
    std::vector<std::string> all;
    const auto summary = Json("out/study.json");
    for (const auto& row : summary["rows"]) all.push_back(row["status"]);
    return all;
  }
  // A study of cheap rows, every other one with files of its own.
  void WriteManyRows(int count) const {
    std::string text = "experiment,command,name\n";
    for (int i = 0; i < count; ++i) {
      text += std::string("experiment.yaml,") + (i % 2 ? "check" : "replay") + ",row_" +
              std::to_string(i) + "\n";
    }
    files_.Write("study.csv", text);
  }
};

TEST_F(Studies, RunEveryRowOnce) {
  const Finished first = Study();
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("row 3/3  fit"));
  EXPECT_THAT(first.out, HasSubstr("3 rows: 3 done"));
  for (const char* file : {"look/findings.json", "look/row.json", "before/errors.json",
                           "before/report.html", "fit/fit.json", "study.csv", "study.html"})
    EXPECT_TRUE(fs::exists(files_ / "out" / file)) << file;
  EXPECT_THAT(Text("out/study.html"), HasSubstr("href=\"fit/report.html\""));
  EXPECT_THAT(Text("out/fit/output.txt"), Not(HasSubstr(".part")));
  const auto before = fs::last_write_time(files_ / "out/fit");
  const Finished second = Study();
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_THAT(second.out, Not(HasSubstr("row 3/3")));
  EXPECT_EQ(fs::last_write_time(files_ / "out/fit"), before);
}

TEST_F(Studies, RecordWhatWentIn) {
  Study({"--rows", "look"});
  const auto record = Json("out/look/row.json");
  EXPECT_EQ(record["version"], "0.1.0");
  EXPECT_EQ(record["model"], "model.xml");
  std::vector<std::string> files;
  for (const auto& [file, hash] : record["sha256"].items()) files.push_back(file);
  EXPECT_THAT(files, ::testing::ElementsAre("experiment.yaml", "log.csv", "model.xml"));
  const auto sum = testing::RunProcess({"/usr/bin/sha256sum", "log.csv"}, files_.folder());
  EXPECT_EQ(sum.out.substr(0, 64), record["sha256"]["log.csv"]);
}

TEST_F(Studies, NameRowsThatFailAndGoOn) {
  files_.Write("diverges.yaml", std::string(kExperiment) + "candidates: [no_such_effect]\n");
  files_.Write("study.csv",
               "experiment,command,options,name\n"
               "none.yaml,check,,missing\n"
               "experiment.yaml,replay,,twice\n"
               "experiment.yaml,check,,twice\n"
               "diverges.yaml,check,,refused\n"
               "experiment.yaml,replay,--nonsense,options\n"
               "experiment.yaml,check,,last\n");
  const Finished f = Study();
  EXPECT_EQ(f.exit_code, 3) << f.err;
  EXPECT_THAT(f.out, HasSubstr("study.csv:2: "));
  EXPECT_THAT(f.out, HasSubstr("none.yaml"));
  EXPECT_THAT(f.out, HasSubstr("study.csv:4: expected a folder of its own"));
  EXPECT_THAT(f.out, HasSubstr("no_such_effect"));
  EXPECT_THAT(f.out, HasSubstr("study.csv:6: The following argument was not expected"));
  EXPECT_THAT(f.out, HasSubstr("6 rows: 2 done, 4 failed"));
  EXPECT_THAT(Statuses(),
              ::testing::ElementsAre("failed", "done", "failed", "failed", "failed", "done"));
  EXPECT_TRUE(fs::exists(files_ / "out/options.failed/messages.txt"));
  EXPECT_FALSE(fs::exists(files_ / "out/options"));
  // Mended, it is done, and the failure is gone.
  Spoil("diverges.yaml", "candidates: [no_such_effect]\n", "");
  EXPECT_EQ(Study({"--rows", "refused"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(files_ / "out/refused/findings.json"));
  EXPECT_FALSE(fs::exists(files_ / "out/refused.failed"));
}

TEST_F(Studies, ChangedInputsAreNamedAndRunOnlyAgain) {
  ASSERT_EQ(Study().exit_code, 0);
  const std::string old = Text("out/before/errors.json");
  files_.Write("log.csv", kOtherLog);
  const Finished named = Study();
  EXPECT_EQ(named.exit_code, 3);
  EXPECT_THAT(named.out, HasSubstr("study.csv:3: "));
  EXPECT_THAT(named.out, HasSubstr("other inputs (log.csv changed); `--again` replaces it"));
  EXPECT_EQ(Text("out/before/errors.json"), old);
  EXPECT_EQ(Study({"--again"}).exit_code, 0);
  EXPECT_NE(Text("out/before/errors.json"), old);
}

TEST_F(Studies, AResultOutlivesARunOfChangedInputsThatFails) {
  ASSERT_EQ(Study().exit_code, 0);
  const std::string old = Text("out/before/errors.json");
  Spoil("log.csv", "0.3,0.1,0.06", "0.3,0.1,oh");
  EXPECT_EQ(Study({"--again"}).exit_code, 3);
  EXPECT_EQ(Text("out/before/errors.json"), old);
  EXPECT_TRUE(fs::exists(files_ / "out/before.failed/row.json"));
  const Finished f = Study();
  EXPECT_THAT(f.out, HasSubstr("and the present ones failed (log.csv:5"));
}

TEST_F(Studies, WithoutValidateLogsShowTheErrorOfTheOthers) {
  ASSERT_EQ(Study({"--rows", "fit"}).exit_code, 0);
  ASSERT_EQ(Study({"--summary"}).exit_code, 3);
  EXPECT_THAT(Text("out/study.html"), Not(HasSubstr(">0 rad<")));
  const auto table = CsvTable::Read(files_ / "out/study.csv");
  EXPECT_EQ(table.Text(2, "error_validate"), "");
  EXPECT_GT(table.Number(2, "error_train"), 0);
}

TEST_F(Studies, ARowWithoutAResultFails) {
  files_.Write("study.csv",
               "experiment,command,options,name\nexperiment.yaml,replay,--help,help\n");
  const Finished f = Study();
  EXPECT_EQ(f.exit_code, 3) << f.err;
  EXPECT_THAT(f.out, HasSubstr("failed   study.csv:2: "));
  EXPECT_THAT(f.out, HasSubstr("help.failed/errors.json: expected a readable file"));
  EXPECT_FALSE(fs::exists(files_ / "out/help"));
}

TEST_F(Studies, AResultThatWasDeletedIsMadeAgain) {
  ASSERT_EQ(Study().exit_code, 0);
  fs::remove(files_ / "out/before/errors.json");
  const Finished seen = Study({"--summary"});
  EXPECT_EQ(seen.exit_code, 3);
  EXPECT_THAT(seen.out, HasSubstr("3 rows: 2 done, 1 missing"));
  EXPECT_EQ(Study().exit_code, 0);
  EXPECT_TRUE(fs::exists(files_ / "out/before/errors.json"));
}

TEST_F(Studies, OfYamlNameARowWithoutAnExperiment) {
  files_.Write("study.yaml",
               "command: check\nrows:\n  - {name: none}\n"
               "  - {name: good, experiment: experiment.yaml}\n");
  const Finished f = Run({"study", "study.yaml", "--out", "out"});
  EXPECT_EQ(f.exit_code, 3) << f.err;
  EXPECT_THAT(f.out, HasSubstr("study.yaml:3, experiment: expected a file, found nothing"));
  EXPECT_THAT(f.out, HasSubstr("2 rows: 1 done, 1 failed"));
}

TEST_F(Studies, WhatIsNoResultIsNotOverwritten) {
  fs::create_directories(files_ / "out/look");
  files_.Write("out/look/thesis.txt", "three years");
  const Finished f = Study();
  EXPECT_EQ(f.exit_code, 3);
  EXPECT_THAT(f.out, HasSubstr("study.csv:2: "));
  EXPECT_THAT(f.out, HasSubstr("is no result of a row"));
  EXPECT_EQ(Study({"--again"}).exit_code, 3);
  EXPECT_EQ(Text("out/look/thesis.txt"), "three years");
}

TEST_F(Studies, RefuseWrongUse) {
  ExpectRefused({"study", "none.csv", "--out", "out"}, {"none.csv"});
  ExpectRefused({"study", "study.csv"}, {"--out"});
  ExpectRefused({"study", "study.csv", "--out", "out", "--rows", "4"}, {"--rows", "rows 1 to 3"});
  ExpectRefused({"study", "study.csv", "--out", "out", "--shard", "0/2"}, {"--shard", "K/N"});
  ExpectRefused({"study", "experiment.yaml", "--out", "out"}, {"--command"});
  ExpectRefused({"study", "study.csv", "--out", "."}, {"study.csv", "the input itself"});
  files_.Write("study.csv", "experiment,command\nexperiment.yaml,check,more\n");
  ExpectRefused({"study", "study.csv", "--out", "out"}, {"study.csv:2"});
}

TEST_F(Studies, OfAPatternTakeTheCommandFromTheirOptions) {
  const Finished list = Run({"study", "exper*.yaml", "--command", "replay", "--list"});
  EXPECT_EQ(list.out, "experiment-replay\n");
  const Finished f = Run({"study", "exper*.yaml", "--command", "identify",
                          "--options=--starts 2 --seed 3", "--out", "out"});
  EXPECT_EQ(f.exit_code, 0) << f.out << f.err;
  EXPECT_EQ(Json("out/experiment-identify/fit.json")["starts"].size(), 2);
}

// Files, bytes and summary but for times are those of a run in one go.
class Shards : public Studies {
 protected:
  Shards() { WriteManyRows(9); }
  void ExpectAsInOneGo() const {
    ASSERT_EQ(Study({"--summary"}).exit_code, 0);
    ASSERT_EQ(Run({"study", "study.csv", "--out", "whole"}).exit_code, 0);
    for (int i = 0; i < 9; ++i) {
      const std::string file =
          "row_" + std::to_string(i) + (i % 2 ? "/findings.json" : "/errors.json");
      EXPECT_EQ(Text("out/" + file), Text("whole/" + file)) << file;
    }
    const auto one = CsvTable::Read(files_ / "whole/study.csv");
    const auto many = CsvTable::Read(files_ / "out/study.csv");
    ASSERT_EQ(one.rows(), many.rows());
    for (const std::string& column : one.columns()) {
      if (column == "seconds" || column == "peak_megabytes") continue;
      for (std::size_t r = 0; r < one.rows(); ++r)
        EXPECT_EQ(one.Text(r, column), many.Text(r, column)) << column;
    }
  }
};

TEST_F(Shards, ByXargsGiveWhatOneRunGives) {
  const Finished f = Shell(PageExample("xargs"));
  EXPECT_EQ(f.exit_code, 0) << f.err << f.out;
  ExpectAsInOneGo();
}

TEST_F(Shards, ByGnuParallelGiveWhatOneRunGives) {
  if (Shell("parallel --version | grep -q GNU").exit_code != 0)
    GTEST_SKIP() << "GNU parallel is not installed";
  const Finished f = Shell(PageExample("parallel "));
  EXPECT_EQ(f.exit_code, 0) << f.err << f.out;
  ExpectAsInOneGo();
}

// sbatch runs the script once for each number of the array.
TEST_F(Shards, ByASlurmArrayGiveWhatOneRunGives) {
  const std::string script = PageExample("#SBATCH --array");
  EXPECT_THAT(script, HasSubstr("#SBATCH --array=1-4"));
  files_.Write("study.slurm", script);
  for (const char* task : {"1", "2", "3", "4"}) {
    const Finished f = Shell(std::string("SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_ID=") + task +
                             " bash study.slurm");
    EXPECT_EQ(f.exit_code, 0) << f.err;
  }
  ExpectAsInOneGo();
}

TEST_F(Shards, BySnakemakeGiveWhatOneRunGives) {
  if (Shell("snakemake --version").exit_code != 0) GTEST_SKIP() << "Snakemake is not installed";
  files_.Write("Snakefile", PageExample("rule row", "python"));
  const Finished f = Shell("snakemake --cores 2 --keep-going");
  EXPECT_EQ(f.exit_code, 0) << f.err << f.out;
  ExpectAsInOneGo();
}

TEST_F(Shards, RunTwiceAtOnceLeaveWholeFolders) {
  const Finished f =
      Shell("for i in 1 2; do continuum study study.csv --out out --rows 1:9 & done; wait");
  EXPECT_EQ(f.exit_code, 0) << f.err;
  ExpectAsInOneGo();
}

class Interrupted : public Studies {
 protected:
  // Every folder but those aside is whole, and of one version of the log.
  void ExpectWhole(const std::map<std::string, std::string>& error_of) const {
    if (!fs::exists(files_ / "out")) return;
    for (const auto& entry : fs::directory_iterator(files_ / "out")) {
      const std::string name = entry.path().filename();
      if (name.starts_with(".") || !entry.is_directory()) continue;
      const std::string record = "out/" + name + "/row.json";
      ASSERT_TRUE(nlohmann::json::accept(Text(record))) << record;
      const std::string version = Json(record)["sha256"]["log.csv"];
      if (Json(record)["command"] == "check") {
        ASSERT_TRUE(nlohmann::json::accept(Text("out/" + name + "/findings.json"))) << name;
        continue;
      }
      ASSERT_TRUE(Text("out/" + name + "/report.html").ends_with("</html>\n")) << name;
      ASSERT_EQ(Text("out/" + name + "/errors.json"), error_of.at(version)) << name;
    }
  }
  // What a row of replay gives for the log as it is.
  void Learn(std::map<std::string, std::string>& error_of) const {
    ASSERT_EQ(Run({"study", "study.csv", "--out", "learnt", "--rows", "1", "--again"}).exit_code,
              0);
    error_of[Json("learnt/row_0/row.json")["sha256"]["log.csv"]] = Text("learnt/row_0/errors.json");
  }
  bool KillAfter(std::chrono::milliseconds wait) const {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(files_.folder().c_str()) != 0 || !freopen("/dev/null", "w", stdout) ||
          !freopen("/dev/null", "w", stderr))
        _exit(127);
      execl(CONTINUUM_EXECUTABLE, "continuum", "study", "study.csv", "--out", "out", "--again",
            nullptr);
      _exit(127);
    }
    std::this_thread::sleep_for(wait);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
  }
};

TEST_F(Interrupted, FiftyKillsLeaveEveryFolderWholeOrAbsent) {
  WriteManyRows(10);
  std::map<std::string, std::string> error_of;
  std::mt19937 random(1);
  int kills = 0;
  for (int round = 0; kills < 50 && round < 200; ++round) {
    if (round % 10 == 0) {  // the inputs change: old results are replaced
      files_.Write("log.csv", round % 20 ? kOtherLog : kLog);
      Learn(error_of);
    }
    kills += KillAfter(std::chrono::milliseconds(random() % 300));
    ExpectWhole(error_of);
  }
  EXPECT_EQ(kills, 50);
  const Finished f = Study({"--again"});
  EXPECT_EQ(f.exit_code, 0) << f.err << f.out;
  ExpectWhole(error_of);
  for (const auto& entry : fs::directory_iterator(files_ / "out"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
}

TEST_F(Interrupted, CtrlCLeavesDoneRowsAndTheNextRunCompletes) {
  std::string text = "t,u,q\n";
  for (int k = 0; k < 20; ++k) text += std::to_string(k * 5e5) + ",0.1,0.1\n";
  files_.Write("endless.csv", text);  // 1e9 time steps
  std::string experiment = kExperiment;
  files_.Write("endless.yaml", experiment.replace(experiment.find("log.csv"), 7, "endless.csv"));
  files_.Write("study.csv", std::string(kRows) + "endless.yaml,replay,endless,new\n");
  const Finished f = testing::RunProcess(
      {CONTINUUM_EXECUTABLE, "study", "study.csv", "--out", "out", "--rows", "2,4"},
      files_.folder(), 60, {"study (2 steps)", SIGINT});
  EXPECT_EQ(f.exit_code, 1) << f.err;
  EXPECT_THAT(f.err, HasSubstr("interrupted"));
  for (const auto& entry : fs::directory_iterator(files_ / "out"))
    EXPECT_EQ(entry.path().filename(), "before");
  EXPECT_EQ(Study({"--rows", "1:3"}).exit_code, 0);
}

// Without rights of an administrator: in a name space of its own.
TEST_F(Interrupted, ByADiskThatIsFullRowsAreNamedAndTheNextRunCompletes) {
  const std::vector<std::string> unshare{"/usr/bin/unshare", "--map-root-user", "--mount"};
  auto probe = unshare;
  probe.emplace_back("/bin/true");
  if (testing::RunProcess(probe, files_.folder()).exit_code != 0)
    GTEST_SKIP() << "this machine gives no name spaces to its users";
  WriteManyRows(8);
  fs::create_directories(files_ / "out");
  auto command = unshare;
  command.insert(command.end(),
                 {"/bin/sh", "-c",
                  "mount -t tmpfs -o size=2m none out || exit 99; head -c 1900000 /dev/zero > "
                  "out/filler; \"$0\" study study.csv --out out; echo \"first $?\"; "
                  "for d in out/row_*; do test -d \"$d\" || continue; "
                  "test -s \"$d/row.json\" || echo \"partial $d\"; done; "
                  "rm out/filler; \"$0\" study study.csv --out out; echo \"second $?\"",
                  CONTINUUM_EXECUTABLE});
  const Finished f = testing::RunProcess(command, files_.folder());
  if (f.out.empty()) GTEST_SKIP() << f.err;
  EXPECT_THAT(f.out, HasSubstr("No space left on device"));
  EXPECT_THAT(f.out, HasSubstr("row 1/8  row_0                    done"));
  EXPECT_THAT(f.out, HasSubstr("failed   study.csv:"));
  EXPECT_THAT(f.out, Not(HasSubstr("partial")));
  EXPECT_THAT(f.out, Not(HasSubstr("first 0")));
  EXPECT_THAT(f.out, HasSubstr("8 rows: 8 done"));
  EXPECT_THAT(f.out, HasSubstr("second 0"));
}

TEST_F(Interrupted, ByALimitOfFileSizeRowsAreNamed) {
  const Finished f = testing::RunProcess(
      {"/bin/sh", "-c", "ulimit -f 8; exec \"$0\" study study.csv --out out --rows 1:2",
       CONTINUUM_EXECUTABLE},
      files_.folder());
  EXPECT_EQ(f.exit_code, 3) << f.err << f.out;
  EXPECT_THAT(f.out, HasSubstr("row 1/3  look                     done"));
  EXPECT_THAT(f.out, HasSubstr("study.csv:3: "));
  EXPECT_FALSE(fs::exists(files_ / "out/before"));
}

}  // namespace
}  // namespace continuum
