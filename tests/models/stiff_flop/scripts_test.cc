#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/process.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

class StiffFlopScripts : public ::testing::Test {
 protected:
  // What a script says that must refuse: one line, exit 2.
  std::string Refusal(const std::string& script, const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"/usr/bin/env", "python3",
                                     CONTINUUM_SOURCE "/models/stiff_flop/" + script};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const testing::Finished finished = testing::RunProcess(command, scratch_.folder());
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_THAT(finished.err, ::testing::StartsWith(script + ": "));
    EXPECT_EQ(finished.err.find('\n'), finished.err.size() - 1) << finished.err;
    EXPECT_EQ(finished.out, "");
    return finished.err;
  }

  testing::Scratch scratch_;
};

TEST_F(StiffFlopScripts, AskForTwoFolders) {
  for (const std::string script : {"import.py", "compare.py"}) {
    EXPECT_THAT(Refusal(script, {}), HasSubstr("_FOLDER, found 0 arguments"));
    EXPECT_THAT(Refusal(script, {"in"}), HasSubstr("_FOLDER, found 1 argument\n"));
  }
}

TEST_F(StiffFlopScripts, ImportNamesAFileThatIsNotTheRecording) {
  EXPECT_THAT(Refusal("import.py", {"in", "out"}), HasSubstr("in/NoLoad.mat: No such file"));
  const std::string folder = scratch_.folder();
  std::string head(128, ' ');
  for (const std::string& content :
       {std::string(), std::string("t,p1\n0,1\n"), head,
        head + std::string("\x0f\0\0\0\x08\0\0\0\x78\x9cgarbage", 17),
        head + std::string("\x0e\0\0\0\x10\0\0\0\x06\0\0\0\x08\0\0\0", 16)}) {
    scratch_.Write("NoLoad.mat", content);
    EXPECT_THAT(Refusal("import.py", {folder, "out"}),
                HasSubstr("NoLoad.mat: expected a MATLAB file (version 5) of 1094 x 18 doubles"));
  }
}

TEST_F(StiffFlopScripts, CompareNamesTheFileThatItCannotRead) {
  EXPECT_THAT(Refusal("compare.py", {"in", "out"}),
              HasSubstr("in: expected 9 logs line*_cycle*.csv, found 0"));
  const std::string folder = scratch_.folder();
  const std::string names = "p1,p2,p3,x,y,z,qw,qx,qy,qz\n";
  const std::string sample = names + "0,0,0,1,2,3,1,0,0,0\n";
  scratch_.Write("line1_cycle1.csv", sample);
  EXPECT_THAT(Refusal("compare.py", {folder, folder}), HasSubstr("found 1\n"));
  for (const char* const line : {"line1", "line2", "line3"}) {
    for (const char* const cycle : {"_cycle1.csv", "_cycle2.csv", "_cycle3.csv"}) {
      scratch_.Write(std::string(line) + cycle, sample);
    }
  }
  EXPECT_THAT(Refusal("compare.py", {folder, folder}),
              HasSubstr("simulated/line1_cycle1.csv: No such file"));
  std::filesystem::create_directory(scratch_ / "simulated");
  scratch_.Write("simulated/line1_cycle1.csv", "x,y\n1,2\n");
  EXPECT_THAT(Refusal("compare.py", {folder, folder}), HasSubstr("expected a column 'z'"));
  scratch_.Write("simulated/line1_cycle1.csv", names);
  EXPECT_THAT(Refusal("compare.py", {folder, folder}), HasSubstr("expected 1 rows as in"));
  scratch_.Write("simulated/line1_cycle1.csv", sample);
  scratch_.Write("line1_cycle1.csv", names + "0,0,0,nan,2,3,1,0,0,0\n");
  EXPECT_THAT(Refusal("compare.py", {folder, folder}), HasSubstr("expected numbers under p1"));
  scratch_.Write("line1_cycle1.csv", names + "0,0,0,1,2,3,0,0,0,0\n");
  EXPECT_THAT(Refusal("compare.py", {folder, folder}), HasSubstr("expected a quaternion"));
}

}  // namespace
}  // namespace continuum
