#include "sim/experiment/experiment_files.h"

#include <algorithm>

#include "sim/io/yaml.h"
#include "sim/model/model_files.h"

namespace continuum {

ExperimentFiles FilesOfExperiment(const std::filesystem::path& experiment) {
  ExperimentFiles files;
  const auto add = [&](const std::filesystem::path& file) {
    const auto plain = file.lexically_normal();
    if (std::find(files.all.begin(), files.all.end(), plain) == files.all.end())
      files.all.push_back(plain);
  };
  const Yaml y = Yaml::Read(experiment);
  add(experiment);
  files.model = y.At("model").File("a model file").lexically_normal();
  for (const auto& file : FilesOfModel(files.model)) add(file);
  for (const Yaml& log : y.At("logs").Items()) add(log.At("file").File("a log file"));
  return files;
}

}  // namespace continuum
