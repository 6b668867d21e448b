#include "sim/io/file_format.h"

#include <algorithm>
#include <fstream>
#include <string>

#include "error.h"

namespace continuum {
namespace {

using namespace std::string_view_literals;

constexpr char kMcap[] =
    "python3 -c \"import mujoco_continuum, pandas; "
    "pandas.DataFrame(mujoco_continuum.read('FILE')).to_csv('NAME.csv', index=False)\"";
constexpr char kRosbags[] = "the Python package rosbags (topics to columns)";

// In a line of conversion FILE and NAME stand for the file and its name without extension.
struct Format {
  std::string_view begin;
  const char *name, *conversion;
};

constexpr Format kFormats[]{
    {"PAR1"sv, "a Parquet file",
     "python3 -c \"import pandas; "
     "pandas.read_parquet('FILE').reset_index().to_csv('NAME.csv', index=False)\""},
    {"ARROW1"sv, "an Arrow file",
     "python3 -c \"import pandas; pandas.read_feather('FILE').to_csv('NAME.csv', index=False)\""},
    {"\x89HDF\r\n\x1a\n"sv, "an HDF5 file",
     "python3 -c \"import h5py, pandas; f = h5py.File('FILE'); pandas.DataFrame({k: f[k][()] for k "
     "in f if f[k].ndim == 1}).to_csv('NAME.csv', index=False)\""},
    {"\x93NUMPY"sv, "a NumPy array",
     "python3 -c \"import numpy; numpy.savetxt('NAME.csv', numpy.load('FILE'), delimiter=',')\""},
    {"\x89MCAP0\r\n"sv, "an MCAP recording", kMcap},
    {"#ROSBAG V"sv, "a ROS bag", kRosbags},
    {"SQLite format 3\0"sv, "an SQLite file, as ROS 2 records", kRosbags},
    {"ULog\x01\x12\x35"sv, "a ULog of PX4", "ulog2csv FILE (pip install pyulog)"},
    {"TDSm"sv, "a TDMS file of LabVIEW", "tdmsinfo FILE; the Python package npTDMS (as_dataframe)"},
    {"MDF     "sv, "an MDF of a measuring system", "the Python package asammdf (to_dataframe)"},
    {"\xD0\xCF\x11\xE0"sv, "an Excel file", "save it as CSV in the spreadsheet program"},
    {"\x1F\x8B"sv, "a gzip file", "gunzip FILE"},
    {"BZh"sv, "a bzip2 file", "bunzip2 FILE"},
    {"\xFD"
     "7zXZ\0"sv,
     "an xz file", "unxz FILE"},
    {"\x28\xB5\x2F\xFD"sv, "a zstd file", "unzstd FILE"},
    {"\xFF\xFE"sv, "text in UTF-16", "iconv -f UTF-16 -t UTF-8 FILE > NAME_utf8.csv"},
    {"\xFE\xFF"sv, "text in UTF-16", "iconv -f UTF-16 -t UTF-8 FILE > NAME_utf8.csv"},
    {"\x80\x04\x95"sv, "a Python pickle",
     "python3 -c \"import pandas; "
     "pandas.DataFrame(pandas.read_pickle('FILE')).reset_index().to_csv('NAME.csv', "
     "index=False)\""},
    {"\x80\x05\x95"sv, "a Python pickle",
     "python3 -c \"import pandas; "
     "pandas.DataFrame(pandas.read_pickle('FILE')).reset_index().to_csv('NAME.csv', "
     "index=False)\""}};

constexpr Format kExcel{""sv, "an Excel file", "save it as CSV in the spreadsheet program"};
constexpr Format kNumpyArrays{""sv, "an archive of NumPy arrays",
                              "python3 -c \"import numpy, pandas; "
                              "pandas.DataFrame(dict(numpy.load('FILE'))).to_csv('NAME.csv', "
                              "index=False)\""};
constexpr Format kZip{""sv, "a zip archive", "unzip FILE"};
constexpr Format kJsonLines{""sv, "JSON",
                            "python3 -c \"import pandas; pandas.read_json('FILE', lines=True, "
                            "convert_dates=False).to_csv('NAME.csv', index=False)\""};
constexpr Format kJson{""sv, "JSON",
                       "python3 -c \"import pandas; pandas.read_json('FILE', "
                       "convert_dates=False).to_csv('NAME.csv', index=False)\""};

const Format* OfZip(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  if (head.find(".npy") != head.npos) return &kNumpyArrays;
  if (head.find("[Content_Types].xml") != head.npos || head.find("xl/") != head.npos)
    return &kExcel;
  return &kZip;
}

// A list or map from the first to the last byte, or one of these a line.
const Format* OfJson(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == bytes.npos) return nullptr;
  const char end = bytes[bytes.find_last_not_of(" \t\r\n")];
  if (bytes[first] == '[' && end == ']') return &kJson;
  if (bytes[first] != '{' || end != '}') return nullptr;
  return bytes.find("}\n{") == bytes.npos ? &kJson : &kJsonLines;
}

// Text has no control characters but line breaks and tabs.
bool IsBinary(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  return std::any_of(head.begin(), head.end(), [](char c) { return c >= 0 && c < 8; });
}

const Format* FormatOf(std::string_view bytes) {
  if (!IsBinary(bytes)) return OfJson(bytes);
  for (const Format& format : kFormats) {
    if (bytes.starts_with(format.begin)) return &format;
  }
  return bytes.starts_with("PK\x03\x04"sv) ? OfZip(bytes) : nullptr;
}

std::string Replaced(std::string text, std::string_view what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace

bool IsMat(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return false;
  std::string head(19, '\0');
  std::ifstream(file, std::ios::binary)
      .read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == "MATLAB 5.0 MAT-file" || head == "MATLAB 7.3 MAT-file";
}

void RequireText(std::string_view bytes, const std::filesystem::path& file) {
  const Format* const format = FormatOf(bytes);
  if (!format) return;
  const auto stem = std::filesystem::path(file).replace_extension();
  const std::string line = Replaced(format->conversion, "FILE", file.string());
  throw Error::Input(
      file.string(), "a text table (CSV) or a MATLAB file",
      std::string(format->name) + "; it is converted by: " + Replaced(line, "NAME", stem.string()));
}

}  // namespace continuum
