#include "sim/io/file_format.h"

#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using namespace std::string_view_literals;
using ::testing::HasSubstr;

std::string Message(std::string_view bytes) {
  try {
    RequireText(bytes, "runs/log.bin");
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    return e.what();
  }
  return "text";
}

TEST(FileFormat, NamesTheFormatAndTheLineThatConverts) {
  EXPECT_THAT(Message("PAR1\x15\x04\x15\0"sv),
              HasSubstr("a Parquet file; it is converted by: python3"));
  EXPECT_THAT(Message("PAR1\x15\x04\x15\0"sv),
              HasSubstr("read_parquet('runs/log.bin').reset_index().to_csv('runs/log.csv'"));
  EXPECT_THAT(Message("\x89HDF\r\n\x1a\n\0"sv), HasSubstr("an HDF5 file"));
  EXPECT_THAT(Message("\x93NUMPY\x01\0"sv), HasSubstr("a NumPy array"));
  EXPECT_THAT(Message("PK\x03\x04\0\0qpos.npy"sv), HasSubstr("an archive of NumPy arrays"));
  EXPECT_THAT(Message("PK\x03\x04\0\0[Content_Types].xml"sv), HasSubstr("an Excel file"));
  EXPECT_THAT(
      Message("\x89MCAP0\r\n\x01\0"sv),
      HasSubstr("an MCAP recording; it is converted by: python3 -c \"import mujoco_continuum"));
  EXPECT_THAT(Message("#ROSBAG V2.0\n\0\0"sv), HasSubstr("a ROS bag"));
  EXPECT_THAT(Message("SQLite format 3\0"sv), HasSubstr("SQLite"));
  EXPECT_THAT(Message("ULog\x01\x12\x35\x01"sv), HasSubstr("ulog2csv runs/log.bin"));
  EXPECT_THAT(Message("MDF     4.10    \0"sv), HasSubstr("asammdf"));
  EXPECT_THAT(Message("\x1F\x8B\x08\0"sv), HasSubstr("gunzip runs/log.bin"));
  EXPECT_THAT(Message("\xFF\xFEt\0,\0x\0"sv), HasSubstr("iconv -f UTF-16"));
  EXPECT_THAT(Message("[{\"t\": 0, \"q\": 1}]\n"sv), HasSubstr("JSON; it is converted by"));
  EXPECT_THAT(Message("{\"t\": 0}\n{\"t\": 1}\n"sv), HasSubstr("lines=True"));
}

TEST(FileFormat, LeavesTextAlone) {
  for (const std::string_view text :
       {""sv, "t,x\n0,1\n"sv, "PAR1,TDSm\n0,1\n"sv, "[t],[x]\n0,1\n"sv, "{t},x\n0,1\n"sv,
        "#ROSBAG V2.0\nt,x\n0,1\n"sv, "\xEF\xBB\xBFt,x\n"sv})
    EXPECT_EQ(Message(text), "text") << text;
}

TEST(FileFormat, KnowsMatlabByItsFirstBytes) {
  const testing::Scratch scratch;
  EXPECT_TRUE(IsMat(scratch.Write("a.log", "MATLAB 5.0 MAT-file, Platform: GLNXA64")));
  EXPECT_TRUE(IsMat(scratch.Write("b.log", "MATLAB 7.3 MAT-file, Platform: GLNXA64")));
  EXPECT_FALSE(IsMat(scratch.Write("c.log", "MATLAB")));
  EXPECT_FALSE(IsMat(scratch / "none.log"));
}

}  // namespace
}  // namespace continuum
