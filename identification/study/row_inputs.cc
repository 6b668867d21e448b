#include "identification/study/row_inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/experiment/experiment_files.h"
#include "sim/io/sha256.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

// Files that options name: "--from fit.json", "--from=fit.json".
std::vector<fs::path> FilesOfOptions(const StudyTable& study, const StudyRow& row) {
  std::vector<fs::path> files;
  for (const std::string& word : row.options) {
    const fs::path file = study.folder / word.substr(word.find('=') + 1);
    std::error_code failed;
    if (fs::is_regular_file(file, failed)) files.push_back(file.lexically_normal());
  }
  return files;
}

void AddChange(const std::string& what, const std::string& before, const std::string& now,
               std::string& text) {
  if (before == now) return;
  text += fmt::format("{}{}: '{}' became '{}'", text.empty() ? "" : "; ", what, before, now);
}

void AddFile(const std::string& file, const char* what, std::string& text) {
  text += (text.empty() ? "" : "; ") + file + what;
}

}  // namespace

std::string RowInputs::Hash() const {
  const nlohmann::json all{command, version, options, files};
  return Sha256(all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

const std::string& FileHashes::Of(const fs::path& file) {
  std::error_code failed;
  const auto changed = fs::last_write_time(file, failed);
  const std::uintmax_t size = fs::file_size(file, failed);
  const auto [at, is_new] = known_.try_emplace(file);
  Known& known = at->second;
  if (is_new || known.hash.empty() || known.changed != changed || known.size != size) {
    known.hash.clear();  // where the file cannot be read
    known = {changed, size, Sha256OfFile(file)};
  }
  return known.hash;
}

RowInputs InputsOf(const StudyTable& study, const StudyRow& row, const std::string& version,
                   FileHashes& hashes) {
  RowInputs inputs{row.command, version, row.options, "", {}};
  const auto name = [&](const fs::path& file) {
    return file.lexically_proximate(study.folder).string();
  };
  const auto add = [&](const fs::path& file) { inputs.files[name(file)] = hashes.Of(file); };
  try {
    const ExperimentFiles files = FilesOfExperiment(study.folder / row.experiment);
    inputs.model = name(files.model);
    for (const fs::path& file : files.all) add(file);
    for (const fs::path& file : FilesOfOptions(study, row)) add(file);
  } catch (const Error& e) {
    throw Error::Input(row.where, e.what());
  }
  return inputs;
}

std::string ChangesBetween(const RowInputs& before, const RowInputs& now) {
  std::string text;
  AddChange("command", before.command, now.command, text);
  AddChange("options", fmt::format("{}", fmt::join(before.options, " ")),
            fmt::format("{}", fmt::join(now.options, " ")), text);
  AddChange("version of continuum", before.version, now.version, text);
  for (const auto& [file, hash] : now.files) {
    const auto old = before.files.find(file);
    if (old == before.files.end()) AddFile(file, " is new", text);
    if (old != before.files.end() && old->second != hash) AddFile(file, " changed", text);
  }
  for (const auto& [file, hash] : before.files) {
    if (!now.files.contains(file)) AddFile(file, " is no longer read", text);
  }
  return text;
}

}  // namespace continuum
