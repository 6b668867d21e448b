#include "sim/io/child_process.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Scratch;

class Child : public ::testing::Test {
 protected:
  ChildEnd Run(const std::string& script) {
    lines_.clear();
    return RunChild({{"/bin/sh", "-c", script}, scratch_.folder(), scratch_ / "out"},
                    [&](const std::string& line) { lines_.push_back(line); });
  }
  Scratch scratch_;
  std::vector<std::string> lines_;
};

TEST_F(Child, RunsInItsFolderAndItsOutputIsAFile) {
  const ChildEnd end = Run("pwd; echo one >&2; echo two >&2; exit 3");
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.signal, 0);
  EXPECT_EQ(end.InWords(), "");
  EXPECT_EQ(end.messages, "one\ntwo\n");
  EXPECT_THAT(lines_, ElementsAre("one", "two"));
  EXPECT_THAT(Scratch::Text(scratch_ / "out"), HasSubstr(scratch_.folder().filename().string()));
  EXPECT_GT(end.peak_megabytes, 0.1);
}

TEST_F(Child, ThatASignalEndsIsNamed) {
  const ChildEnd end = Run("kill -9 $$");
  EXPECT_EQ(end.exit_code, -1);
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_THAT(end.InWords(), HasSubstr("signal 9"));
}

TEST_F(Child, ThatCannotStartIsAnError) {
  EXPECT_THROW(RunChild({{"/no/such/program"}, scratch_.folder(), scratch_ / "out"}, {}), Error);
  EXPECT_THROW(RunChild({{"/bin/true"}, "/no/such/folder", scratch_ / "out"}, {}), Error);
  EXPECT_THROW(RunChild({{"/bin/true"}, "/", "/no/such/folder/out"}, {}), Error);
}

// What a parent leaves that is killed: the script writes a file after a second, unless it died.
TEST_F(Child, DiesWithAParentThatIsKilled) {
  const pid_t parent = fork();
  if (parent == 0) {
    RunChild({{"/bin/sh", "-c", "touch begun; sleep 1; touch survived"},
              scratch_.folder(),
              scratch_ / "out"},
             {});
    _exit(0);
  }
  while (!std::filesystem::exists(scratch_ / "begun"))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "survived"));
}

}  // namespace
}  // namespace continuum
