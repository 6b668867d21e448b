#include "sim/io/file.h"
#include "sim/io/output_folder.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using testing::Scratch;

class Written : public ::testing::Test {
 protected:
  bool Exists(const std::string& name) const { return fs::exists(scratch_ / name); }
  Scratch scratch_;
};

TEST_F(Written, ReachesTheEndOfAChainOfLinks) {
  fs::create_directory(scratch_ / "there");
  fs::create_symlink("there/second", scratch_ / "first");
  fs::create_symlink("../real", scratch_ / "there/second");
  EXPECT_EQ(fs::weakly_canonical(ThroughLinks(scratch_ / "first")),
            fs::weakly_canonical(scratch_ / "real"));
  WriteFile(scratch_ / "first", "text");
  EXPECT_EQ(Scratch::Text(scratch_ / "real"), "text");
  EXPECT_TRUE(fs::is_symlink(scratch_ / "first") && fs::is_symlink(scratch_ / "there/second"));
}

TEST_F(Written, RefusesLinksThatGoRound) {
  fs::create_symlink("b", scratch_ / "a");
  fs::create_symlink("a", scratch_ / "b");
  EXPECT_THROW(WriteFile(scratch_ / "a", "text"), Error);
  EXPECT_TRUE(fs::is_symlink(scratch_ / "a") && fs::is_symlink(scratch_ / "b"));
}

TEST_F(Written, LeavesNothingWhereItFails) {
  fs::create_directory(scratch_ / "folder");
  scratch_.Write("folder/full", "");
  EXPECT_THROW(WriteFile(scratch_ / "folder", "text"), Error);
  EXPECT_THROW(WriteFile(scratch_ / "none/file", "text"), Error);
  const auto entries = fs::directory_iterator(scratch_.folder());
  EXPECT_EQ(std::distance(fs::begin(entries), fs::end(entries)), 1);
}

TEST_F(Written, FoldersGoAgainWhileTheyAreEmpty) {
  {
    const OutputFolder made(scratch_ / "a/b/c", {"file", "folder/"});
    EXPECT_TRUE(Exists("a/b/c"));
  }
  EXPECT_FALSE(Exists("a"));
  {
    const OutputFolder made(scratch_ / "a/b/c", {"file", "folder/"});
    scratch_.Write("a/b/file", "");
  }
  EXPECT_FALSE(Exists("a/b/c"));
  EXPECT_TRUE(Exists("a/b/file"));
  { const OutputFolder old(scratch_ / "a", {}); }
  EXPECT_TRUE(Exists("a/b/file"));
}

TEST_F(Written, OutputsMustBePossibleInTheirFolder) {
  fs::create_directories(scratch_ / "out/there");
  scratch_.Write("out/file", "precious");
  EXPECT_NO_THROW(OutputFolder(scratch_ / "out", {"file", "new", "there/", "not_yet/"}));
  EXPECT_EQ(Scratch::Text(scratch_ / "out/file"), "precious");
  EXPECT_FALSE(Exists("out/new"));
  EXPECT_THROW(OutputFolder(scratch_ / "out", {"there"}), Error);
  EXPECT_THROW(OutputFolder(scratch_ / "out", {"file/"}), Error);
  EXPECT_THROW(OutputFolder(scratch_ / "out/file", {}), Error);
  EXPECT_THROW(RequireWritable(scratch_ / "out/file/below"), Error);
}

TEST_F(Written, AnOutputIsNoInputOfItsJob) {
  const auto model = scratch_.Write("model.xml", "precious");
  fs::create_symlink("model.xml", scratch_ / "link.xml");
  for (const char* name : {"model.xml", "./model.xml", "link.xml"})
    EXPECT_THROW(RequireWritable(scratch_ / name, {model}), Error) << name;
  EXPECT_NO_THROW(RequireWritable(scratch_ / "other.xml", {model, ""}));
  EXPECT_THROW(OutputFolder(scratch_.folder(), {"other.xml", "model.xml"}, {model}), Error);
  EXPECT_EQ(Scratch::Text(model), "precious");
}

TEST_F(Written, WhatKilledProcessesLeftBehindGoes) {
  const pid_t killed = fork();
  if (killed == 0) _exit(0);
  waitpid(killed, nullptr, 0);
  const std::string gone = ".a.txt." + std::to_string(killed) + ".tmp.txt";
  const std::string alive = ".a.txt." + std::to_string(getppid()) + ".tmp.txt";
  const std::string other = ".b.txt." + std::to_string(killed) + ".tmp.txt";
  for (const auto& name : {gone, alive, other, std::string(".a.txt.12x.tmp.txt")})
    scratch_.Write(name, "half");
  WriteFile(scratch_ / "a.txt", "whole");
  EXPECT_FALSE(Exists(gone));
  EXPECT_TRUE(Exists(alive));
  EXPECT_TRUE(Exists(other));
  EXPECT_TRUE(Exists(".a.txt.12x.tmp.txt"));
  EXPECT_EQ(Scratch::Text(scratch_ / "a.txt"), "whole");
}

TEST_F(Written, FilesBeyondMemoryAreNotRead) {
  scratch_.Write("large", "");
  fs::resize_file(scratch_ / "large", 1'000'000'000'000);  // without blocks on the disk
  EXPECT_THROW(ReadFile(scratch_ / "large"), Error);
}

}  // namespace
}  // namespace continuum
