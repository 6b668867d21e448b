#include "identification/study/study_table.h"

#include <glob.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "error.h"
#include "identification/study/option_words.h"
#include "sim/io/csv.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

// Files of a pattern, relative to a folder.
std::vector<std::string> Matches(const fs::path& folder, const std::string& pattern) {
  std::error_code failed;
  if (pattern.find_first_of("*?[") == pattern.npos || fs::exists(folder / pattern, failed))
    return {pattern};
  glob_t found{};
  std::vector<std::string> files;
  if (glob((folder / pattern).c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
      const fs::path file = found.gl_pathv[i];
      files.push_back(fs::path(pattern).is_absolute() ? file : file.lexically_relative(folder));
    }
  }
  globfree(&found);
  return files;
}

// What a row says, as text.
struct Entry {
  std::string where, experiment, command, options, name;
  std::map<std::string, std::string> labels = {};
};

class Builder {
 public:
  Builder(std::string name, fs::path folder) {
    study_.name = std::move(name);
    study_.folder = fs::absolute(folder.empty() ? "." : folder).lexically_normal();
  }

  void AddLabel(const std::string& label) {
    auto& all = study_.labels;
    if (std::find(all.begin(), all.end(), label) == all.end()) all.push_back(label);
  }

  void Add(const Entry& entry) {
    const auto files = Matches(study_.folder, entry.experiment);
    if (files.empty()) {
      AddRow(entry, entry.experiment,
             Error::Input(entry.where, "a file", "none like '" + entry.experiment + "'").what());
    }
    for (const std::string& file : files) AddRow(entry, file, "");
  }

  StudyTable Finish() && {
    if (study_.rows.empty()) throw Error::Input(study_.name, "at least one row", "none");
    return std::move(study_);
  }

 private:
  void AddRow(const Entry& entry, const std::string& experiment, std::string fault) {
    StudyRow row{study_.rows.size() + 1, entry.where, entry.name, experiment, entry.command};
    row.labels = entry.labels;
    row.fault = std::move(fault);
    if (row.name.empty()) row.name = RowName(experiment, row.command);
    try {
      Complete(entry, row);
    } catch (const Error& e) {
      if (row.fault.empty()) row.fault = e.what();
    }
    if (row.fault.empty()) taken_.emplace(row.name, row.number);
    study_.rows.push_back(std::move(row));
  }

  void Complete(const Entry& entry, StudyRow& row) const {
    const auto& known = RowCommands();
    if (std::find(known.begin(), known.end(), row.command) == known.end())
      throw Error::Input(row.where + ", command", fmt::format("{}", fmt::join(known, " | ")),
                         row.command.empty() ? "nothing" : "'" + row.command + "'");
    if (row.experiment.empty()) throw Error::Input(row.where + ", experiment", "a file", "nothing");
    row.options = OptionWords(entry.options, row.where + ", options");
    for (const std::string& word : row.options) {
      if (word == "--out" || word.starts_with("--out="))
        throw Error::Input(row.where + ", options", "no --out, which the study chooses", word);
    }
    CheckRowName(row.name, row.where + ", name");
    const auto found = taken_.find(row.name);
    if (found == taken_.end()) return;
    const StudyRow& other = study_.rows[found->second - 1];
    throw Error::Input(
        row.where, "a folder of its own (give it a `name`)",
        fmt::format("'{}', that of row {} ({})", row.name, other.number, other.where));
  }

  StudyTable study_;
  std::map<std::string, std::size_t> taken_;  // names of folders, and the numbers of their rows
};

StudyTable ReadTable(const fs::path& file, const StudyDefaults& defaults) {
  const CsvTable table = CsvTable::Read(file);
  Builder builder(file.string(), file.parent_path());
  if (!table.Has("experiment"))
    throw Error::Input(file.string(), "a column 'experiment'",
                       fmt::format("{}", fmt::join(table.columns(), ", ")));
  const auto is_label = [](const std::string& column) {
    return column != "experiment" && column != "command" && column != "options" && column != "name";
  };
  for (const std::string& column : table.columns()) {
    if (is_label(column)) builder.AddLabel(column);
  }
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const auto cell = [&](const char* column, const std::string& otherwise) {
      const std::string text = table.Has(column) ? table.Text(r, column) : "";
      return text.empty() ? otherwise : text;
    };
    Entry entry{table.Where(r), cell("experiment", ""), cell("command", defaults.command),
                cell("options", defaults.options), cell("name", "")};
    for (const std::string& column : table.columns()) {
      if (is_label(column)) entry.labels[column] = table.Text(r, column);
    }
    builder.Add(entry);
  }
  return std::move(builder).Finish();
}

std::string PlaceOf(const Yaml& y) {
  const std::string where = y.Where();
  return where.substr(0, where.find(": "));
}

StudyTable ReadYaml(const fs::path& file, const Yaml& y, const StudyDefaults& defaults) {
  y.Only({"command", "options", "rows"});
  const std::string command = y.TextOr("command", defaults.command);
  const std::string options = y.TextOr("options", defaults.options);
  Builder builder(file.string(), file.parent_path());
  for (const Yaml& item : y.At("rows").Items()) {
    item.Only({"experiment", "command", "options", "name", "labels"});
    Entry entry{PlaceOf(item), item.TextOr("experiment", ""), item.TextOr("command", command),
                item.TextOr("options", options), item.TextOr("name", "")};
    if (const auto labels = item.Find("labels")) {
      for (const std::string& label : labels->Keys()) {
        builder.AddLabel(label);
        entry.labels[label] = labels->At(label).Text();
      }
    }
    builder.Add(entry);
  }
  return std::move(builder).Finish();
}

StudyTable OfExperiments(const std::vector<std::string>& patterns, const StudyDefaults& defaults) {
  if (defaults.command.empty())
    throw Error::Input("--command", "what to do with each experiment", "nothing");
  Builder builder(fmt::format("{}", fmt::join(patterns, " ")), ".");
  for (const std::string& pattern : patterns)
    builder.Add({pattern, pattern, defaults.command, defaults.options, "", {}});
  return std::move(builder).Finish();
}

}  // namespace

StudyTable ReadStudy(const std::vector<std::string>& sources, const StudyDefaults& defaults) {
  const fs::path first = sources.front();
  const std::string kind = first.extension().string();
  std::error_code failed;
  if (sources.size() > 1 || first.string().find_first_of("*?[") != std::string::npos)
    return OfExperiments(sources, defaults);
  if (!fs::exists(first, failed)) throw Error::Input(first.string(), "a study", "no such file");
  if (kind != ".yaml" && kind != ".yml") return ReadTable(first, defaults);
  const Yaml y = Yaml::Read(first);
  return y.Has("rows") ? ReadYaml(first, y, defaults) : OfExperiments(sources, defaults);
}

}  // namespace continuum
