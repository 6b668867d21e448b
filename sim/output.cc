#include "sim/output.h"

#include <system_error>

#include "sim/file.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

constexpr int kLinks = 40;  // as many as Linux follows

// Standard output and its like, also when it happens to be a file.
bool IsStandardStream(const fs::path& path) {
  std::error_code failed;
  const std::string text = fs::absolute(path, failed).lexically_normal().string();
  return text == "/dev/stdout" || text == "/dev/stderr" || text.starts_with("/dev/fd/") ||
         text.starts_with("/proc/");
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

OutFolder::OutFolder(const fs::path& path) {
  std::error_code ignored;
  for (fs::path p = fs::absolute(path, ignored).lexically_normal();
       p.has_relative_path() && !fs::exists(p, ignored); p = p.parent_path()) {
    made_.push_back(p);
  }
  try {
    MakeFolder(path);
  } catch (...) {
    RemoveEmpty();
    throw;
  }
}

OutFolder::~OutFolder() { RemoveEmpty(); }

void OutFolder::RemoveEmpty() {
  std::error_code not_empty;
  for (const fs::path& p : made_) fs::remove(p, not_empty);
}

}  // namespace continuum
