#include "sim/io/output_folder.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <system_error>

#include "error.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

void RequireOutput(const fs::path& folder, const std::string& name,
                   const std::vector<fs::path>& inputs) {
  if (!name.ends_with('/')) return RequireWritable(folder / name, inputs);
  const fs::path inner = folder / name.substr(0, name.size() - 1);
  std::error_code failed;
  if (!fs::exists(inner, failed)) return;
  if (!fs::is_directory(inner, failed)) throw Error::Input(inner.string(), "a folder", "a file");
  RequireWritable(inner / "log.csv", inputs);
}

}  // namespace

void RequireWritable(const fs::path& path, const std::vector<fs::path>& inputs) {
  const fs::path target = ThroughLinks(path);
  if (IsStream(target)) return;
  std::error_code failed;
  for (const fs::path& input : inputs) {
    if (fs::equivalent(target, input, failed))
      throw Error::Input(path.string(), "an output beside the inputs", "the input itself");
  }
  if (fs::is_directory(target, failed)) {
    throw Error::Input(path.string(), "a writable file", "a folder");
  }
  const fs::path temporary = TemporaryPath(target);
  std::ofstream probe(temporary);
  if (!probe) throw Error::Input(path.string(), "a writable file", std::strerror(errno));
  probe.close();
  fs::remove(temporary, failed);
}

void RequireDistinct(const std::vector<fs::path>& outputs) {
  std::set<fs::path> files;
  for (const fs::path& output : outputs) {
    if (output.empty() || IsStream(output)) continue;
    std::error_code failed;
    const fs::path file = fs::weakly_canonical(fs::absolute(ThroughLinks(output), failed), failed);
    if (files.insert(file).second) continue;
    throw Error::Input(output.string(), "a file of its own for every output", "that of another");
  }
}

OutputFolder::OutputFolder(const fs::path& path, const std::vector<std::string>& outputs,
                           const std::vector<fs::path>& inputs) {
  std::error_code ignored;
  for (fs::path p = fs::absolute(path, ignored).lexically_normal();
       p.has_relative_path() && !fs::exists(p, ignored); p = p.parent_path()) {
    made_.push_back(p);
  }
  try {
    MakeFolder(path);
    for (const std::string& output : outputs) RequireOutput(path, output, inputs);
  } catch (...) {
    RemoveEmpty();
    throw;
  }
}

OutputFolder::~OutputFolder() { RemoveEmpty(); }

void OutputFolder::RemoveEmpty() {
  std::error_code not_empty;
  for (const fs::path& p : made_) fs::remove(p, not_empty);
}

}  // namespace continuum
