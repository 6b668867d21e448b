#include "app/load_model.h"

#include <cstdio>
#include <string>

#include "sim/model/engine_warnings.h"
#include "sim/model/lost_instances.h"

namespace continuum {
namespace {

void Warn(const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); }

}  // namespace

ModelSpec LoadModel(const std::filesystem::path& model) {
  const EngineWarnings warnings;
  ModelSpec spec = ModelSpec::Load(model);
  for (const std::string& text : warnings.texts()) {
    if (text.starts_with("continuum.")) Warn(text);
  }
  for (const std::string& text : LostInstances(model, spec.model())) Warn(text);
  return spec;
}

}  // namespace continuum
