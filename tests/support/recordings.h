#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace continuum::testing {

/// Where the recordings of a real machine are, if they are at hand: below $CONTINUUM_DATA, else
/// below ../shared/data beside the project.
inline std::filesystem::path Recordings(const std::string& machine) {
  const char* const chosen = std::getenv("CONTINUUM_DATA");
  return std::filesystem::path(chosen ? chosen : CONTINUUM_SOURCE "/../shared/data") / machine;
}

}  // namespace continuum::testing
