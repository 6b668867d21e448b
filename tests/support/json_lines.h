#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace continuum::testing {

/// What a benchmark that goes on where it stopped has written: one JSON object per line. A last
/// line that was cut short is left out; no file: nothing.
inline std::vector<nlohmann::json> ReadJsonLines(const std::filesystem::path& file) {
  std::vector<nlohmann::json> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    auto json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_object()) lines.push_back(std::move(json));
  }
  return lines;
}

inline void AppendJsonLine(const std::filesystem::path& file, const nlohmann::json& line) {
  std::ofstream(file, std::ios::app) << line.dump() << std::endl;
}

}  // namespace continuum::testing
