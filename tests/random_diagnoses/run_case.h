#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace continuum::random_diagnoses {

/// What became of a random case.
struct Outcome {
  std::uint64_t seed = 0;
  int exit_code = -1;   ///< as of `continuum diagnose`: 0, 1 or 2
  std::string verdict;  ///< or the message of the error
  double seconds = 0;
  std::vector<std::string> problems;  ///< that must not be; none: all is well
  std::vector<std::string> trace;     ///< of a crash, innermost first
};
nlohmann::json OutcomeJson(const Outcome& outcome);

/// Makes a random case, diagnoses it with small budgets and writes all files, in a process of its
/// own. A problem is a crash, more than limit seconds of processor time, an exception that is no
/// Error, an Error without words, a number in diagnosis.json that is not finite, a cause that no
/// list knows. keep: a folder for the case's files, which stay there; empty: they go.
Outcome RunCase(std::uint64_t seed, unsigned limit, const std::filesystem::path& keep = {});

}  // namespace continuum::random_diagnoses
