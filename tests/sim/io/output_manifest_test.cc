#include "sim/io/output_manifest.h"

#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using testing::Scratch;

class OwnFilesTest : public ::testing::Test {
 protected:
  OwnFilesTest() {
    Job({"a.csv", "b.csv"});
    EXPECT_TRUE(Has("a.csv") && Has("b.csv"));
  }

  // A job that writes these files.
  void Job(const std::vector<std::string>& names) const {
    OutputManifest files(scratch_.folder());
    for (const std::string& name : names) files.Write(name, "of " + name);
    files.Finish();
  }
  bool Has(const std::string& name) const { return fs::exists(scratch_ / name); }

  Scratch scratch_;
};

TEST_F(OwnFilesTest, GoWhenALaterJobDoesNotWriteThem) {
  Job({"b.csv", "c.csv"});
  EXPECT_FALSE(Has("a.csv"));
  EXPECT_TRUE(Has("b.csv") && Has("c.csv"));
  Job({});
  EXPECT_FALSE(Has("b.csv") || Has("c.csv"));
}

TEST_F(OwnFilesTest, StayWhereSomebodyChangedThem) {
  scratch_.Write("a.csv", "of somebody else");
  Job({"b.csv"});
  EXPECT_EQ(Scratch::Text(scratch_ / "a.csv"), "of somebody else");
}

TEST_F(OwnFilesTest, LeaveEverythingElseInTheFolder) {
  scratch_.Write("mine.csv", "of a.csv");
  fs::remove(scratch_ / "a.csv");
  fs::create_symlink("mine.csv", scratch_ / "a.csv");
  fs::create_directory(scratch_ / "folder");
  Job({});
  EXPECT_TRUE(Has("mine.csv") && Has("a.csv") && Has("folder"));
}

// Whoever writes lists cannot have files elsewhere removed.
TEST_F(OwnFilesTest, AreSoughtInTheFolderAlone) {
  fs::create_directory(scratch_ / "in");
  scratch_.Write("in/.written", Scratch::Text(scratch_ / ".written"));
  std::string list = Scratch::Text(scratch_ / ".written");
  list.insert(list.find("a.csv"), "../");
  scratch_.Write("in/.written", list + "\n.. ..\nzz\n1 .written\n");
  OutputManifest(scratch_ / "in").Finish();
  EXPECT_TRUE(Has("a.csv") && Has("b.csv"));
  EXPECT_EQ(Scratch::Text(scratch_ / "in/.written"), "");
}

// As after a job that was killed.
TEST_F(OwnFilesTest, StayWithoutAList) {
  fs::remove(scratch_ / ".written");
  Job({"b.csv"});
  EXPECT_TRUE(Has("a.csv"));
}

}  // namespace
}  // namespace continuum
