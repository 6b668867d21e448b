// The bundled example, as who has just installed the program meets it.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/process.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Demo, CopiesTheExampleAndDiagnosesTheCopy) {
  const testing::Scratch files;
  // The diagnosis takes a minute, and other tests look at it: here it is asked to stop.
  const auto f = testing::RunProcess(
      {"/usr/bin/timeout", "--signal=INT", "1", CONTINUUM_EXECUTABLE, "demo"}, files.folder());
  EXPECT_THAT(f.out + f.err,
              HasSubstr("continuum diagnose continuum_demo/annelida/demo/annelida.yaml"));
  const fs::path copy = files / "continuum_demo" / "annelida";
  EXPECT_GT(fs::file_size(copy / "annelida.xml"), 1000u);
  EXPECT_GT(fs::file_size(copy / "demo" / "annelida.yaml"), 1000u);
  EXPECT_GT(fs::file_size(copy / "demo" / "right_left_2.csv"), 1000u);
}

TEST(Demo, NamesAPlaceThatCannotBeWritten) {
  const testing::Scratch files;
  files.Write("taken", "a file");
  const auto f =
      testing::RunProcess({CONTINUUM_EXECUTABLE, "demo", "--out", "taken"}, files.folder());
  EXPECT_EQ(f.exit_code, 2);
  EXPECT_THAT(f.err, AllOf(HasSubstr("taken"), HasSubstr("continuum: ")));
}

}  // namespace
}  // namespace continuum
