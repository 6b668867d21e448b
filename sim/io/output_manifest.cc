#include "sim/io/output_manifest.h"

#include <sstream>

#include <fmt/core.h>

#include "error.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

constexpr char kList[] = ".written";

// FNV-1a.
std::uint64_t SumOf(std::string_view content) {
  std::uint64_t sum = 14695981039346656037u;
  for (const char c : content) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return sum;
}

// A file of the folder itself, on a line of the list.
bool IsName(const std::string& name) {
  return name != kList && name != ".." && fs::path(name).filename() == name &&
         name.find('\n') == name.npos;
}

bool Holds(const fs::path& file, std::uint64_t sum) {
  std::error_code failed;
  return fs::is_regular_file(fs::symlink_status(file, failed)) && SumOf(ReadFile(file)) == sum;
}

}  // namespace

OutputManifest::OutputManifest(const fs::path& folder) : folder_(folder) {
  MakeFolder(folder_);
  before_ = ReadList();
}

void OutputManifest::Write(const std::string& name, std::string_view content) {
  WriteFile(folder_ / name, content);
  if (IsName(name)) now_[name] = SumOf(content);
}

void OutputManifest::Finish() {
  std::error_code failed;
  for (const auto& [name, sum] : before_) {
    if (!now_.contains(name) && Holds(folder_ / name, sum)) fs::remove(folder_ / name, failed);
  }
  std::string list;
  for (const auto& [name, sum] : now_) list += fmt::format("{:016x} {}\n", sum, name);
  WriteFile(folder_ / kList, list);
}

OutputManifest::Sums OutputManifest::ReadList() const {
  Sums sums;
  if (!fs::exists(folder_ / kList)) return sums;
  std::istringstream lines(ReadFile(folder_ / kList));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::uint64_t sum = 0;
    std::string name;
    if (in >> std::hex >> sum && in.get() == ' ' && std::getline(in, name) && IsName(name))
      sums[name] = sum;
  }
  return sums;
}

}  // namespace continuum
