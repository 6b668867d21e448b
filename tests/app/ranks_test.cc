// ctest labels: slow
// `mpirun -n N continuum ...`: ranks share one job, and not a byte of its results depends on N.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <thread>

#include <nlohmann/json.hpp>

#include "bench.h"
#include "page_example.h"
#include "support/long_test.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::PageExample;
using testing::Scratch;

// A pendulum with dry friction that the model does not have, and an offset of its motor.
struct Pendulum {
  double inertia = 0.03, dry = 0.1, offset = 0;  // [kg m^2], [Nm], [Nm]
  bool held = false;                             // its input, from row to row
};

std::string PendulumLog(double frequency, const Pendulum& p = {}) {
  constexpr double kStep = 0.001, kWeight = 1.47, kDamping = 0.1;
  std::string text = "t,u,q\n";
  double q = 0, v = 0, u = 0;
  for (int k = 0; k < 2000; ++k) {
    const bool row = k % 20 == 0;
    if (row || !p.held) u = 0.9 * std::sin(frequency * k * kStep);
    if (row) {
      const double noise = 1e-3 * std::sin(12.9898 * k * frequency);
      text += std::to_string(k * kStep) + "," + std::to_string(u) + "," +
              std::to_string(q + noise) + "\n";
    }
    const double load = p.dry * std::tanh(50 * v) + kDamping * v + kWeight * std::sin(q);
    v += kStep * (u + p.offset - load) / p.inertia;
    q += kStep * v;
  }
  return text;
}

constexpr char kThreeLogs[] = R"(format: 1
model: model.xml
time: {column: t, unit: s}
inputs: [{column: u, unit: Nm, actuator: motor}]
outputs: [{column: q, unit: rad, sensor: angle, sigma: 0.001}]
parameters:
  - {name: b, target: "joint:hinge", attribute: damping, lower: 0.001, upper: 1}
  - {name: J, target: "joint:hinge", attribute: armature, lower: 0, upper: 0.1}
candidates: [coulomb, stiffness]
logs: [{file: one.csv}, {file: two.csv}, {file: three.csv, use: validate}]
)";
constexpr char kPairCandidates[] =
    "candidates: [coulomb, stribeck, directional_friction, input_offset, gravity_tilt]";

// What does not say how long it took, or where.
nlohmann::json WithoutTimes(const nlohmann::json& json) {
  if (!json.is_structured()) return json;
  nlohmann::json kept = json.is_array() ? nlohmann::json::array() : nlohmann::json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array()) kept.push_back(WithoutTimes(value));
    const bool time = key.ends_with("seconds") || key == "peak_megabytes";
    if (json.is_object() && !time) kept[key] = WithoutTimes(value);
  }
  return kept;
}

class Ranks : public testing::AppBench {
 protected:
  static constexpr int kRows = 8;

  Ranks() {
    // As root, and with more ranks than cores.
    for (const char* const allowed : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                                      "OMPI_MCA_rmaps_base_oversubscribe"})
      setenv(allowed, "1", 1);
    files_.Write("one.csv", PendulumLog(2));
    files_.Write("two.csv", PendulumLog(5));
    files_.Write("three.csv", PendulumLog(3));
    files_.Write("arm.yaml", kThreeLogs);
    WritePair();
    std::string study = "experiment,command,name\n";
    for (int i = 0; i < kRows; ++i) {
      const char* const command = i % 3 == 0 ? "replay" : i % 3 == 1 ? "check" : "identify";
      study += std::string("experiment.yaml,") + command + ",row_" + std::to_string(i) + "\n";
    }
    files_.Write("study.csv", study);
  }
  void SetUp() override {
    if (Shell("mpirun -n 1 true").exit_code != 0) GTEST_SKIP() << "mpirun does not run here";
    if (Run({"--version"}).out.find("without MPI") != std::string::npos)
      GTEST_SKIP() << "built without MPI";
  }

  static std::string Text(const fs::path& file) { return Scratch::Text(file); }
  nlohmann::json Json(const std::string& file) const {
    return nlohmann::json::parse(Text(files_ / file));
  }

  // An experiment, pair.yaml, with two causes, in time steps that leave noise alone.
  void WritePair() const {
    std::string text = kThreeLogs, model = testing::kModel;
    const auto replace = [](std::string& in, const std::string& old, const std::string& by) {
      for (std::size_t at = 0; (at = in.find(old, at)) != in.npos; at += by.size())
        in.replace(at, old.size(), by);
    };
    replace(text, "candidates: [coulomb, stiffness]", kPairCandidates);
    replace(text, "{file: ", "{file: pair_");
    replace(text, "model.xml", "fine.xml");
    replace(model, "timestep=\"0.01\"", "timestep=\"0.001\"");
    files_.Write("pair.yaml", text);
    files_.Write("fine.xml", model);
    const Pendulum p{.inertia = 0.05, .dry = 0.03, .offset = 0.05, .held = true};
    for (const auto& [name, frequency] : {std::pair{"one", 2}, {"two", 5}, {"three", 3}})
      files_.Write(std::string("pair_") + name + ".csv", PendulumLog(frequency, p));
  }

  // Of each data file of folders; times are left out.
  std::map<std::string, std::string> Results(const std::vector<std::string>& folders) const {
    std::map<std::string, std::string> all;
    for (const std::string& folder : folders) {
      for (const auto& entry : fs::recursive_directory_iterator(files_ / folder)) {
        const std::string name = entry.path().lexically_relative(files_.folder()).string();
        const std::string kind = entry.path().extension();
        if (kind == ".json") all[name] = WithoutTimes(nlohmann::json::parse(Text(entry))).dump(1);
        const bool data = kind == ".csv" || kind == ".xml" || kind == ".yaml";
        if (data && entry.path().filename() != "study.csv") all[name] = Text(entry);
      }
    }
    return all;
  }

  // What a script with "mpirun -n 2 " writes without that, on one core, and with 2, 3 and 8 ranks.
  void ExpectTheSameBytes(const std::string& script,
                          const std::vector<std::string>& folders) const {
    const auto wanted = ResultsWith("", script, folders);
    EXPECT_GE(wanted.size(), 2);
    for (const char* const start :
         {"taskset -c 0 ", "mpirun -n 2 ", "mpirun -n 3 ", "mpirun -n 8 "})
      ExpectEqual(ResultsWith(start, script, folders), wanted, start);
  }

 private:
  static constexpr unsigned kSeconds = 300;  // on a busy machine

  std::map<std::string, std::string> ResultsWith(const std::string& start, std::string script,
                                                 const std::vector<std::string>& folders) const {
    for (const std::string& folder : folders) fs::remove_all(files_ / folder);
    const std::string two = "mpirun -n 2 ";
    for (std::size_t at = 0; (at = script.find(two, at)) != script.npos; at += start.size())
      script.replace(at, two.size(), start);
    const Finished f = Shell("set -e\n" + script, kSeconds);
    EXPECT_EQ(f.exit_code, 0) << start << f.err;
    EXPECT_EQ(f.err.find(" ranks: tasks ") != f.err.npos, start.starts_with("mpirun")) << f.err;
    return Results(folders);
  }
  static void ExpectEqual(const std::map<std::string, std::string>& found,
                          const std::map<std::string, std::string>& wanted,
                          const std::string& ranks) {
    EXPECT_EQ(found.size(), wanted.size()) << ranks;
    for (const auto& [name, text] : wanted) {
      ASSERT_TRUE(found.contains(name)) << ranks << name;
      EXPECT_EQ(found.at(name), text) << ranks << name;
    }
  }
};

TEST_F(Ranks, OfTheExamplesOfThePageGiveTheSameBytes) {
  ExpectTheSameBytes(PageExample("mpirun -n 2"), {"out", "fit", "cause"});
  const auto cause = Json("cause/diagnosis.json");
  EXPECT_EQ(cause["folds"].size(), 3);
  EXPECT_EQ(cause["candidates"][0]["placebos"].size(), 20);
}

TEST_F(Ranks, WithPairsOfCausesGiveTheSameBytes) {
  ExpectTheSameBytes("mpirun -n 2 continuum diagnose pair.yaml --effort thorough --out cause",
                     {"cause"});
  EXPECT_GE(Json("cause/diagnosis.json")["pairs"].size(), 3);
}

TEST_F(Ranks, WithSeveralStartsGiveTheSameBytes) {
  ExpectTheSameBytes("mpirun -n 2 continuum identify arm.yaml --starts 7 --out fit", {"fit"});
  EXPECT_EQ(Json("fit/fit.json")["starts"].size(), 7);
}

TEST_F(Ranks, OnTheSmoothPathGiveTheSameBytes) {
  ExpectTheSameBytes("mpirun -n 2 continuum identify arm.yaml --path smooth --starts 2 --out fit",
                     {"fit"});
}

TEST_F(Ranks, AreRefusedWhereEachWouldDoTheSame) {
  const Finished check = Shell("mpirun -n 2 continuum check arm.yaml");
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_THAT(check.err, HasSubstr("continuum: mpirun: expected study, identify or diagnose"));
  const Finished quick = Shell("mpirun -n 2 continuum diagnose arm.yaml --out out");
  EXPECT_EQ(quick.exit_code, 2);
  EXPECT_THAT(quick.err, HasSubstr("--effort: expected thorough"));
  const Finished none = Shell("mpirun -n 2 continuum identify none.yaml --out out");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("continuum: none.yaml"));
  EXPECT_THAT(none.err, Not(HasSubstr("rank 1")));
  EXPECT_FALSE(fs::exists(files_ / "out"));
}

TEST_F(Ranks, OfOtherVersionsAreRefusedByName) {
  std::string other = Text(CONTINUUM_EXECUTABLE);
  for (std::size_t at = 0; (at = other.find("0.1.0", at)) != other.npos;)
    other.replace(at, 5, "0.1.9");
  fs::permissions(files_.Write("other", other), fs::perms::owner_all);
  const std::string study = " study study.csv --out out ";
  const Finished f = Shell("mpirun -n 1 continuum" + study + ": -n 1 ./other" + study);
  EXPECT_EQ(f.exit_code, 2) << f.err;
  EXPECT_THAT(f.err, HasSubstr("continuum: mpirun: the ranks differ in the version of continuum"));
  EXPECT_THAT(f.err, HasSubstr("has 0.1.9"));
  EXPECT_FALSE(fs::exists(files_ / "out"));
}

TEST_F(Ranks, OfAStudySayWhichRowsFail) {
  Spoil("study.csv", "experiment.yaml,check,row_4", "none.yaml,check,row_4");
  const Finished f = Shell("mpirun -n 3 continuum study study.csv --out out");
  EXPECT_EQ(f.exit_code, 3) << f.err;
  EXPECT_THAT(f.out, HasSubstr("none.yaml"));
  EXPECT_THAT(f.out, HasSubstr("8 rows: 7 done, 1 failed"));
}

class KilledRanks : public Ranks {
 protected:
  static constexpr auto npos = std::string::npos;

  // mpirun with its messages in the file "said".
  pid_t Start(const std::string& command) const {
    const pid_t job = fork();
    if (job != 0) return job;
    const std::string line = "PATH=$PWD/bin:$PATH exec " + command + " 2> said > /dev/null";
    if (chdir(files_.folder().c_str()) == 0)
      execl("/bin/bash", "bash", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  static std::vector<pid_t> ChildrenOf(pid_t process) {
    const std::string number = std::to_string(process);
    std::istringstream list(Text("/proc/" + number + "/task/" + number + "/children"));
    std::vector<pid_t> children;
    for (pid_t child = 0; list >> child;) children.push_back(child);
    return children;
  }
  std::vector<fs::path> Rows() const {
    std::vector<fs::path> rows;
    if (!fs::exists(files_ / "out")) return rows;
    for (const auto& entry : fs::directory_iterator(files_ / "out"))
      if (entry.path().filename().string().starts_with("row_")) rows.push_back(entry);
    return rows;
  }
  void ExpectWholeFolders() const {
    for (const fs::path& row : Rows())
      EXPECT_TRUE(nlohmann::json::accept(Text(row / "row.json"))) << row;
  }
  // Waits for processes that are no children of this one.
  static void AwaitEnd(const std::vector<pid_t>& processes) {
    for (const pid_t one : processes) {
      for (int looks = 0; looks < 3000 && kill(one, 0) == 0; ++looks)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      EXPECT_NE(kill(one, 0), 0) << "rank goes on without mpirun";
    }
  }
  // Kills a rank, or mpirun itself, some time after the job has written one more row: all have
  // joined by then, and work. Returns whether it did so; the job may have ended before.
  bool KillOneAtWork(std::mt19937& random) const {
    if (Rows().size() > kRows / 2) fs::remove_all(files_ / "out");
    const std::size_t before = Rows().size();
    const pid_t job = Start("mpirun -n 3 continuum study study.csv --out out");
    int status = 0;
    while (Rows().size() == before) {
      if (waitpid(job, &status, WNOHANG) == job) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 50));
    const std::vector<pid_t> ranks = ChildrenOf(job);
    const std::size_t which = random() % (ranks.size() + 1);
    const bool of_rank = which < ranks.size();
    const bool killed = !ranks.empty() && kill(of_rank ? ranks[which] : job, SIGKILL) == 0;
    waitpid(job, &status, 0);
    AwaitEnd(ranks);
    if (!of_rank) return killed && WIFSIGNALED(status);
    const std::string said = Text(files_ / "said");
    const bool noticed = said.find("mpirun noticed that process rank") != npos;
    // Of one that has left, mpirun does not know the name.
    const bool outside = said.find("1 process returned") != npos;
    EXPECT_TRUE(noticed || outside || !killed || status == 0) << said;
    return noticed;
  }
};

// mpirun ends the others when it notices, and says which one it was.
TEST_F(KilledRanks, LeaveWholeFoldersAndTheNextRunCompletes) {
  const int wanted = testing::IsLongRun() ? 50 : 5;
  std::mt19937 random(1);
  int kills = 0;
  for (int round = 0; kills < wanted && round < 3 * wanted; ++round) {
    kills += KillOneAtWork(random);
    ExpectWholeFolders();
  }
  EXPECT_EQ(kills, wanted);
  const Finished f = Shell("mpirun -n 2 continuum study study.csv --out out");
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, HasSubstr("8 rows: 8 done"));
  ExpectWholeFolders();
}

TEST_F(KilledRanks, EndAnIdentificationByName) {
  const pid_t job = Start("mpirun -n 2 continuum identify arm.yaml --starts 500 --out fit");
  std::this_thread::sleep_for(std::chrono::seconds(3));
  const std::vector<pid_t> ranks = ChildrenOf(job);
  ASSERT_EQ(ranks.size(), 2) << Text(files_ / "said");
  EXPECT_EQ(kill(ranks[1], SIGKILL), 0);
  int status = 0;
  waitpid(job, &status, 0);
  EXPECT_NE(status, 0);
  EXPECT_THAT(Text(files_ / "said"), HasSubstr("mpirun noticed that process rank"));
  EXPECT_FALSE(fs::exists(files_ / "fit/fit.json"));
}

}  // namespace
}  // namespace continuum
