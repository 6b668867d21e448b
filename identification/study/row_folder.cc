#include "identification/study/row_folder.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "error.h"
#include "sim/io/host_name.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

constexpr char kPart[] = ".part", kOld[] = ".old";

std::string Mine() { return HostName() + "-" + std::to_string(getpid()); }

bool Rename(const fs::path& from, const fs::path& to) {
  return rename(from.c_str(), to.c_str()) == 0;
}

// Whether a name ends with ".HOST-PROCESS.part" of a process that is gone.
bool IsLeftBehind(std::string name) {
  if (!name.starts_with('.')) return false;
  for (const char* const end : {kPart, kOld}) {
    if (!name.ends_with(end)) continue;
    name.erase(name.size() - std::strlen(end));
    const std::string host = "." + HostName() + "-";
    const std::size_t at = name.rfind(host);
    if (at == name.npos) return false;
    pid_t process = 0;
    const char* const last = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + at + host.size(), last, process);
    if (error != std::errc{} || stop != last || process <= 0) return false;
    return kill(process, 0) != 0 && errno == ESRCH;
  }
  return false;
}

}  // namespace

RowFolder::RowFolder(const fs::path& study, const std::string& row)
    : study_(study),
      path_(study / ("." + row + "." + Mine() + kPart)),
      old_(study / ("." + row + "." + Mine() + kOld)) {
  std::error_code failed;
  fs::remove_all(path_, failed);
  fs::create_directories(path_, failed);
  if (failed) throw Error::Input(path_.string(), "a folder that can be written", failed.message());
}

RowFolder::~RowFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  fs::remove_all(old_, ignored);
}

void RowFolder::Become(const std::string& name) {
  const fs::path place = study_ / name;
  std::error_code failed;
  if (fs::exists(place, failed)) {
    // Both at once where the file system can; else the old one is aside for a moment.
    if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0) return;
    if (!Rename(place, old_)) throw Error::Job(place.string() + ": " + std::strerror(errno));
  }
  if (Rename(path_, place)) return;
  const std::string why = std::strerror(errno);
  Rename(old_, place);
  throw Error::Job(place.string() + ": cannot be written: " + why);
}

void RemoveLeftBehind(const fs::path& study) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(study, failed)) {
    std::error_code ignored;
    if (IsLeftBehind(entry.path().filename().string())) fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace continuum
