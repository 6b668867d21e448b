#include "sim/io/json.h"

#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/file.h"

namespace continuum {

nlohmann::json ReadJson(const std::filesystem::path& file) {
  try {
    return nlohmann::json::parse(ReadFile(file));
  } catch (const nlohmann::json::exception& e) {
    throw Error::Input(file.string(), "JSON", e.what());
  }
}

}  // namespace continuum
