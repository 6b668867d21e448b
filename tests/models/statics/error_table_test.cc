#include "models/statics/error_table.h"

#include <unistd.h>

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/statics/measured_points.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"

namespace continuum::statics {
namespace {

using testing::HasSubstr;

class StaticsErrorTable : public testing::Test {
 protected:
  StaticsErrorTable()
      : folder_(std::filesystem::temp_directory_path() / fmt::format("errors_{}", getpid())) {
    MakeFolder(folder_);
    for (int i = 1; i <= 5; ++i) table_.Add(false, Eigen::Vector2d(1e-3 * i, 1e-3 * i * i));
    table_.Add(true, Eigen::Vector2d(NAN, 2e-3));
  }
  ~StaticsErrorTable() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  ErrorTable table_{0.1, 2};
};

TEST_F(StaticsErrorTable, HasMeansSharesAndQuartilesByDiskAndSet) {
  table_.Write(folder_ / "e.csv");
  const CsvTable read = CsvTable::Read(folder_ / "e.csv");
  ASSERT_EQ(read.rows(), 5u);  // train: 1, 2, all; test: 2, all
  EXPECT_EQ(read.Text(0, "set"), "train");
  EXPECT_EQ(read.Text(0, "disk"), "1");
  EXPECT_DOUBLE_EQ(read.Number(0, "mae"), 3e-3);
  EXPECT_DOUBLE_EQ(read.Number(0, "mape"), 3);
  EXPECT_DOUBLE_EQ(read.Number(0, "q1"), 2e-3);
  EXPECT_DOUBLE_EQ(read.Number(0, "median"), 3e-3);
  EXPECT_NEAR(read.Number(0, "std"), std::sqrt(2.5) * 1e-3, 1e-15);
  EXPECT_DOUBLE_EQ(read.Number(1, "mae"), 11e-3);
  EXPECT_DOUBLE_EQ(read.Number(1, "max"), 25e-3);
  EXPECT_EQ(read.Text(2, "disk"), "all");
  EXPECT_DOUBLE_EQ(read.Number(2, "mae"), 7e-3);
  EXPECT_EQ(read.Text(3, "set"), "test");
  EXPECT_EQ(read.Text(3, "disk"), "2");
}

TEST_F(StaticsErrorTable, SaysTheTipsOfBothSets) {
  EXPECT_EQ(table_.Sentence(),
            "distance from measured points: train, tip of 5: mean 11 mm (11 % of the length), "
            "largest 25 mm; test, tip of 1: mean 2 mm (2 % of the length), largest 2 mm");
}

TEST_F(StaticsErrorTable, DrawsTheBoxesInEveryFormat) {
  for (const char* ending : {"e.svg", "e.png", "e.pdf"}) {
    table_.Draw(folder_ / ending, "a robot");
    EXPECT_GT(ReadFile(folder_ / ending).size(), 1000u) << ending;
  }
  EXPECT_THAT(ReadFile(folder_ / "e.svg"), HasSubstr("a robot"));
}

std::string MessageOf(const std::string& text) {
  try {
    ReadMeasuredPoints(CsvTable::Parse(text, "m.csv"), 3);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(StaticsMeasuredPoints, TakesTheTipByEitherNameAndDisksThatWereMeasured) {
  const auto read = ReadMeasuredPoints(
      CsvTable::Parse("case,x,y,z,x_1,y_1,z_1,use\na,1,2,3,,,,test\nb,4,5,6,7,8,9,\n", "m.csv"), 3);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_TRUE(read[0].test);
  EXPECT_EQ(read[0].count(), 1);
  EXPECT_EQ(read[0].disks.col(2), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read[1].disks.col(0), Eigen::Vector3d(7, 8, 9));
  EXPECT_FALSE(read[1].Has(1));
}

TEST(StaticsMeasuredPoints, SaysWhatIsWrongWithATable) {
  EXPECT_THAT(MessageOf("case,x,y\na,1,2\n"), HasSubstr("a column 'z'"));
  EXPECT_THAT(MessageOf("case,x,y,z,x_3,y_3,z_3\na,1,2,3,1,2,3\n"), HasSubstr("the tip once"));
  EXPECT_THAT(MessageOf("case,x_4,y_4,z_4\na,1,2,3\n"), HasSubstr("'x_4'"));
  EXPECT_THAT(MessageOf("case,x,y,z\na,1,,3\n"), HasSubstr("m.csv:2"));
  EXPECT_THAT(MessageOf("case,x,y,z\na,1,2,3\na,1,2,3\n"), HasSubstr("'a' again"));
  EXPECT_THAT(MessageOf("case,x,y,z,use\na,1,2,3,later\n"), HasSubstr("train or test"));
  EXPECT_THAT(MessageOf("case,x,y,z\na,,,\n"), HasSubstr("at least one measured disk"));
}

}  // namespace
}  // namespace continuum::statics
