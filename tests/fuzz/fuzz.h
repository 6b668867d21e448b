#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "error.h"

namespace continuum::fuzz {

/// Bytes may be refused by our Error alone, and with words.
template <class F>
int Refused(const F& read) {
  try {
    read();
  } catch (const Error& e) {
    if (*e.what() == '\0') std::abort();
  }
  return 0;
}

/// A folder in memory, one per process and left to it.
inline const std::filesystem::path& Folder() {
  static const std::filesystem::path folder = [] {
    std::string name = "/dev/shm/continuum_fuzz_XXXXXX";
    if (!mkdtemp(name.data())) std::abort();
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(Folder(), ignored);
    });
    return std::filesystem::path(name);
  }();
  return folder;
}

inline std::filesystem::path Write(const char* name, std::string_view text) {
  const auto file = Folder() / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

inline std::string_view Text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace continuum::fuzz
