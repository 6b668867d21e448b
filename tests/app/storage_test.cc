// ctest labels: slow
// Disks that are full or cannot be written, and jobs that die: every file is old, new or absent.
#include <algorithm>
#include <cstdint>
#include <map>

#include <nlohmann/json.hpp>

#include "bench.h"
#include "support/long_test.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using testing::Finished;
using ::testing::HasSubstr;
using testing::Scratch;

using Arguments = std::vector<std::string>;

// Every command that writes files, into the folder "there".
std::vector<Arguments> Writers() {
  const std::string tdcr = CONTINUUM_SOURCE "/models/tdcr/";
  return {{"run", "model.xml", "--until", "60", "--out", "there/x.csv"},
          {"run", "model.xml", "--until", "3", "--out", "x.csv", "--video", "there/x.mp4"},
          {"replay", "experiment.yaml", "--out", "there/out"},
          {"render", "experiment.yaml", "--out", "there/x.mp4"},
          {"render", "experiment.yaml", "--out", "there/x.png"},
          {"identify", "experiment.yaml", "--out", "there/out"},
          {"diagnose", "experiment.yaml", "--out", "there/out"},
          {"apply", "diagnosis.json", "model.xml", "--out", "there/x.xml"},
          {"solve", tdcr + "tdcr.yaml", "--input", tdcr + "cases.csv", "--out", "there/x.csv"}};
}

class Storage : public testing::AppBench {
 protected:
  Storage() {
    std::string log = "t,u,q\n";
    for (int k = 0; k < 30; ++k)
      log += std::to_string(0.05 * k) + "," + std::to_string(k / 10 - 1) + ",0.0" +
             std::to_string(k % 7) + "\n";
    files_.Write("log.csv", log);
    files_.Write("again.csv", log);
    Spoil("experiment.yaml", "format: 1", "format: 1\ncandidates: [coulomb]");
    Spoil("experiment.yaml", "{file: log.csv}", "{file: log.csv}, {file: again.csv}");
    fs::create_directory(files_ / "there");
  }

  void SetUp() override {
    CONTINUUM_LONG_IF_SANITIZED("LeakSanitizer crashes at the end of some films");
  }

  // Without rights of an administrator: in a name space of its own.
  Finished RunWhere(const std::string& mount, const Arguments& arguments) const {
    const std::string script = mount +
                               " || exit 99; \"$@\"; code=$?; "
                               "find there -type f -printf 'left %p\\n' >&2; exit $code";
    Arguments all{"/usr/bin/unshare",  "--map-root-user", "--mount", "/bin/sh", "-c", script, "sh",
                  CONTINUUM_EXECUTABLE};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return testing::RunProcess(std::move(all), files_.folder());
  }
  void ExpectFailsWhere(const std::string& mount, const std::string& reason) const {
    if (testing::RunProcess({"/usr/bin/unshare", "--map-root-user", "--mount", "/bin/true"},
                            files_.folder())
            .exit_code != 0)
      GTEST_SKIP() << "this machine gives no name spaces to its users";
    for (const Arguments& command : Writers()) {
      SCOPED_TRACE(command.front() + " " + command.back());
      const auto f = RunWhere(mount, command);
      if (f.exit_code == 99) GTEST_SKIP() << f.err;
      EXPECT_EQ(f.exit_code, 2) << f.err;
      EXPECT_THAT(f.err, HasSubstr("continuum: there/"));
      EXPECT_THAT(f.err, HasSubstr(reason));
      EXPECT_THAT(f.err, ::testing::Not(HasSubstr(".tmp"))) << "a half-written file is left";
    }
  }
};

TEST_F(Storage, ThatIsFullIsNamedAndLeavesNoHalfOfAFile) {
  ExpectFailsWhere("mount -t tmpfs -o size=4k none there && echo 0 > there/a",
                   "No space left on device");
}

TEST_F(Storage, ThatCannotBeWrittenIsNamed) {
  ExpectFailsWhere("mount --bind there there && mount -o remount,bind,ro there",
                   "Read-only file system");
}

TEST_F(Storage, LimitOfAFileIsNamedAndLeavesNoHalfOfIt) {
  for (Arguments command : Writers()) {
    SCOPED_TRACE(command.front() + " " + command.back());
    command.insert(command.begin(), {"/bin/sh", "-c", "ulimit -f 0; exec \"$@\" 2>/dev/null", "sh",
                                     CONTINUUM_EXECUTABLE});
    const auto before = Listing();
    const auto f = testing::RunProcess(command, files_.folder());
    EXPECT_EQ(f.signal, 0);
    EXPECT_EQ(f.exit_code, 2);
    EXPECT_EQ(Listing(), before);
  }
}

TEST_F(Storage, BehindStandardOutputThatIsFullIsNoticed) {
  for (const char* command :
       {"run model.xml --until 1", "run model.xml --until 60", "effects", "effects --json",
        "models", "check experiment.yaml", "replay experiment.yaml --out there", "--version"}) {
    SCOPED_TRACE(command);
    const auto f = testing::RunProcess(
        {"/bin/sh", "-c", CONTINUUM_EXECUTABLE + (" " + std::string(command)) + " > /dev/full"},
        files_.folder());
    EXPECT_EQ(f.exit_code, 2);
    EXPECT_THAT(f.err, HasSubstr("continuum: standard output: expected a writable file, found "));
  }
}

// The boxes of an MP4 file end where it does, and its index is among them.
bool IsWholeFilm(const std::string& bytes) {
  std::size_t at = 0;
  bool index = false;
  while (at + 8 <= bytes.size()) {
    std::uint32_t size = 0;
    for (int i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(bytes[at + i]);
    index |= bytes.compare(at + 4, 4, "moov") == 0;
    if (size < 8) return false;
    at += size;
  }
  return index && at == bytes.size();
}

class Killed : public Storage {
 protected:
  static bool IsWhole(const fs::path& file) {
    const std::string text = Scratch::Text(file), kind = file.extension();
    if (kind == ".json") return nlohmann::json::accept(text);
    if (kind == ".mp4") return IsWholeFilm(text);
    const std::string end = kind == ".html" ? "</html>\n" : kind == ".xml" ? "</mujoco>\n" : "\n";
    return text.ends_with(end);
  }
  // Files of the folder but for those that are written aside, and their numbers of lines.
  std::map<std::string, std::size_t> Finals() const {
    std::map<std::string, std::size_t> lines;
    for (const std::string& name : Listing()) {
      if (!name.starts_with("there/") || !fs::is_regular_file(files_ / name)) continue;
      if (fs::path(name).filename().string().starts_with(".")) continue;
      const std::string text = Scratch::Text(files_ / name);
      lines[name] = std::count(text.begin(), text.end(), '\n');
    }
    return lines;
  }
  void ExpectFinalsWhole(const std::map<std::string, std::size_t>& all) const {
    for (const auto& [name, lines] : Finals()) {
      EXPECT_TRUE(all.contains(name)) << name;
      EXPECT_TRUE(IsWhole(files_ / name)) << name;
      if (name.ends_with(".csv")) {
        EXPECT_EQ(lines, all.at(name)) << name;
      }
    }
  }
  // Dies in every write, over old files and where there are none.
  void ExpectWhole(const Arguments& command) {
    SCOPED_TRACE(command.front());
    const auto first = Run(command);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const auto all = Finals();
    int deaths = 0;
    for (int k = 1, died = SIGKILL; died; k += 1 + k / 6, ++deaths) {
      if (k % 2) fs::remove_all(files_ / "there"), fs::create_directory(files_ / "there");
      Arguments dying{"/usr/bin/env", "LD_PRELOAD=" CONTINUUM_DIE_AT_WRITE,
                      "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0",
                      "DIE_AT=" + std::to_string(k), CONTINUUM_EXECUTABLE};
      dying.insert(dying.end(), command.begin(), command.end());
      SCOPED_TRACE("at write " + std::to_string(k));
      died = testing::RunProcess(dying, files_.folder()).signal;
      EXPECT_TRUE(died == SIGKILL || died == 0);
      ExpectFinalsWhole(all);
    }
    EXPECT_GT(deaths, 1) << "it never died";
    EXPECT_EQ(Run(command).exit_code, 0);
    ExpectFinalsWhole(all);
    EXPECT_EQ(Finals().size(), all.size());
  }
};

TEST_F(Killed, RunLeavesWholeFiles) {
  ExpectWhole({"run", "model.xml", "--until", "50", "--out", "there/x.csv"});
}
TEST_F(Killed, ReplayLeavesWholeFiles) {
  ExpectWhole({"replay", "experiment.yaml", "--out", "there/out"});
}
TEST_F(Killed, FilmIsWholeOrAbsent) {
  ExpectWhole(
      {"run", "model.xml", "--until", "1", "--out", "there/x.csv", "--video", "there/x.mp4"});
}
TEST_F(Killed, FitLeavesWholeFiles) {
  ExpectWhole({"identify", "experiment.yaml", "--out", "there/out"});
}
TEST_F(Killed, DiagnosisLeavesWholeFiles) {
  ExpectWhole({"diagnose", "experiment.yaml", "--out", "there/out"});
}

}  // namespace
}  // namespace continuum
