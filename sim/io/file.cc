#include "sim/io/file.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "error.h"

namespace continuum {
namespace fs = std::filesystem;
namespace {

constexpr int kLinks = 40;  // as many as Linux follows

// Standard output and its like, also when it happens to be a file.
bool IsStandardStream(const fs::path& path) {
  std::error_code failed;
  const std::string text = fs::absolute(path, failed).lexically_normal().string();
  return text == "/dev/stdout" || text == "/dev/stderr" || text.starts_with("/dev/fd/") ||
         text.starts_with("/proc/");
}

void WriteInPlace(const fs::path& path, std::string_view content) {
  std::ofstream out(path, std::ios::binary | std::ios::app);
  if (out) out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) throw Error::Input(path.string(), "a writable file", std::strerror(errno));
}

const char* KindName(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

// Files named before, process, after whose process is gone: it was killed while it wrote.
void RemoveLeftBehind(const fs::path& folder, const std::string& before, const std::string& after) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(before) || !name.ends_with(after)) continue;
    pid_t process = 0;
    const char* const end = name.data() + name.size() - after.size();
    const auto [stop, error] = std::from_chars(name.data() + before.size(), end, process);
    if (error != std::errc() || stop != end || process <= 0) continue;
    if (kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), failed);
  }
}

}  // namespace

fs::path ThroughLinks(const fs::path& path) {
  std::error_code failed;
  fs::path target = path;
  for (int hop = 0; hop < kLinks && fs::is_symlink(target, failed); ++hop) {
    if (IsStandardStream(target)) break;
    const fs::path next = fs::read_symlink(target, failed);
    if (failed) break;
    target = target.parent_path() / next;
  }
  return target;
}

bool IsStream(const fs::path& path) {
  std::error_code failed;
  return IsStandardStream(path) || fs::is_other(path, failed);
}

void RequireFile(const fs::path& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status)) {
    throw Error::Input(path.string(), "a regular file", KindName(status.type()));
  }
  constexpr std::uintmax_t kLargest = 4'000'000'000;
  const std::uintmax_t size = fs::file_size(path, failed);
  if (failed || size <= kLargest) return;
  throw Error::Input(path.string(), "a file of at most 4 GB", std::to_string(size) + " bytes");
}

std::string ReadFile(const fs::path& path) {
  RequireFile(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error::Input(path.string(), "a readable file", std::strerror(errno));
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw Error::Input(path.string(), "a readable file", std::strerror(errno));
  return text;
}

fs::path TemporaryPath(const fs::path& path) {
  const std::string before = "." + path.filename().string() + ".";
  const std::string after = ".tmp" + path.extension().string();
  RemoveLeftBehind(path.parent_path(), before, after);
  fs::path temporary = path;
  return temporary.replace_filename(before + std::to_string(getpid()) + after);
}

void WriteFile(const fs::path& path, std::string_view content) {
  const fs::path target = ThroughLinks(path);
  std::error_code failed;
  if (IsStream(target)) return WriteInPlace(target, content);  // a rename would destroy it
  if (fs::is_symlink(target, failed)) {
    throw Error::Input(path.string(), "a writable file", "symbolic links without an end");
  }
  const fs::path temporary = TemporaryPath(target);
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  if (out) out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  const std::string reason = out ? "" : std::strerror(errno);
  if (out) fs::rename(temporary, target, failed);
  if (out && !failed) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw Error::Input(path.string(), "a writable file", out ? failed.message() : reason);
}

void WriteOrRemove(const std::filesystem::path& path, std::string_view content) {
  if (content.empty()) {
    std::filesystem::remove(path);
  } else {
    WriteFile(path, content);
  }
}

void MakeFolder(const fs::path& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed || !fs::is_directory(path)) {
    throw Error::Input(path.string(), "a folder that can be written", failed.message());
  }
}

}  // namespace continuum
